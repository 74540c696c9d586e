//! Thresholds for smooth edges, each with its reason: what counts as thin, grazing or visible.

use crate::scene::MAX_HALVINGS;

/// Width in pixels of the widest thing that may slip between samples.
pub const THIN_WIDTH: f64 = 2.0;
/// Distance in pixels inside of the outline of a caster at which all of a pixel is in shadow: a little more than its
/// diagonal.
pub const FULL_SHADOW_DEPTH: f64 = 1.5;
/// Size in pixels of a box below which its contents are treated as one thing. The ball around it then ends within
/// the pixel beside the rays where boxes are always searched: what a ray finds does not depend on how far the others
/// of its packet search.
pub const MERGED_SIZE: f64 = 0.5;
/// Size in pixels below which a mesh may slip between samples as a whole. With 8, shadows of a row of gates, of 12
/// faces each, break into dashes: 49 dB instead of 52; a city of 144 boxes takes 0.7 of the rays, for 1 dB less.
pub const SMALL_MESH_PIXELS: f64 = 1.0;
/// Number of faces per pixel of the square around it above which a larger mesh may do so as well. With 16, most of a
/// bar of 500 faces that is a quarter of a pixel wide and less than six long is missing: 52 dB instead of 61. With
/// 128, 400 knots of 24,000 faces take twice as long as with this, for 0.5 dB.
pub const CROWDED_FACES_PER_PIXEL: f64 = 64.0;
/// Cosine below which a surface seen at a grazing angle stretches a pixel no further.
pub const GRAZING: f64 = 0.25;
/// The same on flat surfaces, as far as they go: floors are seen at such angles up to the horizon, and shadows on
/// them are as flat, and slip between samples. With 0.25, most of the shadows of 60 parasols, seen by somebody who
/// stands among them, are missing: 37 dB instead of 61. On all faces, however small, a knot on a floor takes 1.3
/// times as long, for nothing.
pub const GRAZING_ON_FLATS: f64 = 0.04;
/// Half the width of a highlight of exponent p, in units of 1/√p: it has fallen to 1 % there.
pub const HIGHLIGHT_REACH: f64 = 3.0;
/// Steps of the finest grid in a pixel; each is half of the side of the smallest cells.
pub const PIXEL_STEPS: usize = 1 << (MAX_HALVINGS + 2);
/// Difference between the corners of a cell, summed over the channels, times its side in pixels, above which it is
/// divided if they see different things: an edge in it is off by half of its side at most, and the pixel by half of
/// this, three levels of 255.
pub const EDGE_ERROR: f64 = 0.025;
/// How far a colour on a side of a pixel may lie outside of the range between those at the side's ends, summed over
/// the channels, before the pixel is divided: what ends in there covers a quarter of it at most.
pub const MAX_EXCESS: f64 = 0.1;
/// Sampling of crowded pixels, by the number of the smallest cells to their side: the number of samples all over the
/// pixel and the step from one to the next, two Fibonacci numbers, along whose lattice no edge runs. A pixel is
/// crowded if all sixteen parts are to be divided, some of them only because something thin is near. A ball of fur
/// is 2 dB closer for as many rays, a railing in a chrome pipe 6 dB for fewer. Without the condition that something
/// is near, thousands of balls in few pixels are 2 dB farther off; with a grid of 12 × 12, eight pixels of a forest
/// are off by more than 8 levels, and one with this.
pub const SPREAD_OUT: [(usize, (usize, usize)); 3] = [(16, (144, 89)), (8, (34, 21)), (4, (8, 5))];
/// Contrast assumed for what may be seen in a gap between two things. Gaps are looked for along with the things'
/// edges; only those wider than the uncertainty of the edges are found.
pub const GAP_CONTRAST: f64 = 0.2;
/// Light on a surface up to which the edge of a shadow on it does not count: four levels of 255, which nobody sees.
pub const EDGE_CONTRAST: f64 = 4.0 / 255.0;
/// Number of visible objects from which on a scene is crowded: what a strongly curved mirror shows of them is small,
/// and there are many such images.
pub const CROWDED_OBJECTS: usize = 1_000;
/// How many times as fast as the camera's own a pixel may widen along mirrored rays that still look into meshes for
/// what slips between samples: in the image of a strongly curved mirror all of their faces do. Without this limit a
/// knot of 24,000 faces takes four times as long, for 0.3 dB. In crowded scenes, rays to lights look for nothing
/// above this limit: if they searched, 10,000 mirror balls would take 1.13 times as long, and be as far off.
pub const MAX_SPREAD_INTO_MESHES: f64 = 24.0;
/// The same for mirrored rays from whose hits thin things are looked for on the way to lights, in scenes that are
/// not crowded: without this limit two mirror balls between mirror walls take 1.16 times as long, for 0.1 dB. With a
/// limit of 24, of 120 scenes of balls, mirrors and slivers eight more would have a pixel off by more than 8.
pub const MAX_SPREAD_TO_LIGHTS: f64 = 60.0;
/// The same for rays that look for thin things at all in crowded scenes: hardly anything in such a mirror fills a
/// pixel by itself. Without this limit, the 10,000 mirror balls take 1.2 times as long, for 0.3 dB; a grid with that
/// error takes 1.1 times as long.
pub const MAX_SPREAD_WHEN_CROWDED: f64 = 300.0;
/// Greatest distance from a thing in a cell to the nearest corner, in sides of the cell: half its diagonal, and a
/// little for rounding.
pub const FARTHEST_CORNER: f64 = 0.75;
/// Least distance in pixels that rays note for what is treated as one thing, even if they go through it: it is
/// searched for in pixels and their halves, not in smaller cells. This lies between the distances that count as near
/// in halves and in quarters; if it were equal to one of them, rounding would decide.
pub const MIN_NOTED_DISTANCE: f64 = 0.4 * FARTHEST_CORNER;
/// How much something even may deviate, as a share of the range of the corners' colours: the middle of a cell from
/// the mean of its corners, which an edge between two colours puts at least a quarter away; and colours of one face
/// from each other.
pub const UNEVEN: f64 = 0.125;
/// How much the sums of opposite corners of something even may differ, as a share of the range of the corners'
/// colours: they are equal where colours change evenly, and differ by the whole range where one corner shows
/// something else.
pub const MAX_TWIST: f64 = 0.25;
