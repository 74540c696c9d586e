//! What is thin, grazing or visible: every threshold of smooth edges, with its reason.

use crate::scene::MAX_HALVINGS;

/// Widest thing, in pixels, that may slip between samples.
pub const SLIPPING: f64 = 2.0;
/// How far inside of the outline of what casts a shadow, in pixels, all of a pixel is in it: a little more than its
/// diagonal.
pub const HIDDEN: f64 = 1.5;
/// What is in a box that is less than so many pixels large is looked at as one thing. The ball around it then ends
/// within the pixel beside the rays in which boxes are looked for at all: what a ray finds does not depend on how
/// far the others of its packet look.
pub const ONE_THING: f64 = 0.5;
/// A mesh that is less than so many pixels large may slip between samples as a whole. With 8, shadows of a row of gates,
/// of 12 faces each, break into dashes: 49 dB in place of 52; a city of 144 boxes takes 0.7 of the rays, for 1 dB less.
pub const SMALL: f64 = 1.0;
/// So does a larger one that has more faces than this for each pixel of the square around it. With 16, most of a bar of 500
/// faces that is a quarter of a pixel wide and less than six long is missing: 52 dB in place of 61. With 128, 400 knots of
/// 24,000 faces take twice as long as with this, for 0.5 dB.
pub const CROWDED: f64 = 64.0;
/// Cosine below which a surface seen at a grazing angle does not stretch a pixel any further.
pub const GRAZING: f64 = 0.25;
/// The same of what is flat, as far as it goes: floors are seen like that up to the horizon, and shadows on them are as
/// flat, and slip between samples. With 0.25, of the shadows of 60 parasols, seen by somebody who stands among them, most
/// are missing: 37 dB in place of 61. On all faces, however small, a knot on a floor takes 1.3 times as long, for nothing.
pub const GRAZING_ON_FLATS: f64 = 0.04;
/// Half the width of a highlight of exponent p, in units of 1/√p: it has fallen to 1 % there.
pub const HIGHLIGHT_REACH: f64 = 3.0;
/// Steps of the finest grid in a pixel: half of the side of the smallest cells.
pub const FINEST: usize = 1 << (MAX_HALVINGS + 2);
/// Difference of the corners of a cell, summed over the channels, times its side in pixels, above which it
/// is divided where they see different things: an edge in it is off by half of its side at most, and the
/// pixel by half of this, three levels of 255.
pub const EDGE_ERROR: f64 = 0.025;
/// How far a colour on a side of a pixel may be from all between those at its ends, summed over the channels, before the
/// pixel beside it is divided for it: what ends in there covers a quarter of it at most.
pub const TELLING: f64 = 0.1;
/// Samples all over a pixel of which all sixteen parts are to be divided, some of them for what is near alone, in place of
/// so many of the smallest cells to its side, and the step from one to the next: two numbers of Fibonacci, along whose
/// lattice no edge runs. A ball of fur is 2 dB closer for as many rays, a railing in a chrome pipe 6 dB for fewer. Without
/// regard to what is near, of thousands of balls in few pixels the picture is 2 dB farther off; in a grid of 12 × 12, eight
/// pixels of a forest are off by more than 8 levels, and one with this.
pub const SPREAD_OUT: [(usize, (usize, usize)); 3] = [(16, (144, 89)), (8, (34, 21)), (4, (8, 5))];
/// Contrast of what may be seen in a gap between two things, which is looked for along with their edges: gaps that are
/// wider than they are known within are found.
pub const GAP_CONTRAST: f64 = 0.2;
/// So much light on a surface is an edge where it ends in shadow: four levels of 255, which nobody sees.
pub const EDGE_CONTRAST: f64 = 4.0 / 255.0;
/// So many objects are a crowd: what of them is in a strongly curved mirror is small, and there are many such images.
pub const CROWD: usize = 1_000;
/// How many times as fast as the camera's own a pixel may widen along mirrored rays that still look into meshes for what
/// slips between samples: in the image of a strongly curved mirror all of their faces do. Without this a knot of 24,000
/// of them takes four times as long, for 0.3 dB.
/// Where a scene is crowded, those that go on from there to a light look for nothing: with that 10,000 mirror balls take
/// 1.13 times as long, and are as far off.
pub const LARGEST_SPREAD: f64 = 24.0;
/// How many times as fast it may widen along mirrored rays that look for what is thin on the way to lights from there, in
/// scenes that are not crowded: without this two mirror balls between mirror walls take 1.16 times as long, for 0.1 dB.
/// Beyond 24 instead, of 120 scenes of balls, mirrors and slivers eight more would have a pixel off by more than 8.
pub const WIDEST_TO_LIGHTS: f64 = 60.0;
/// How many times as fast it may widen along rays that look at all where a scene is crowded: what is in such a mirror is in
/// hardly any pixel by itself. Without this those balls take 1.2 times as long again, for 0.3 dB; the grid of that error,
/// 1.1 times.
pub const WIDEST_SPREAD: f64 = 300.0;
/// A thing can be in a cell without being nearer than this to a corner, in sides of the cell: half
/// its diagonal, and a little for the rounding.
pub const NEAR: f64 = 0.75;
/// How near rays come to what is looked at as one thing at most, in pixels, also where they go through it: it is looked
/// for in pixels and their halves, and not in smaller cells. Between what these count as near: where it is the same as one
/// of them, rounding decides.
pub const CLOSE: f64 = 0.4 * NEAR;
/// How far what is even may be from it, in parts of the range of the corners' colours: the middle of a cell from their
/// mean, which an edge between two colours puts a quarter away at least; and colours of one face from each other.
pub const UNEVEN: f64 = 0.125;
/// How much the corners of what is even may stand out, in parts of the range of their colours: the sums of opposite ones
/// are the same where colours change evenly, and differ by the whole range where one of them shows something else.
pub const TWISTED: f64 = 0.25;
