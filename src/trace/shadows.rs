//! The shadows that samples are in and that end near them: between two of these a pixel may be lit although all its
//! corners are dark, and between shadows of two lights there may be light of both or of neither.
//!
//! A sample notes for each light the mark of the caster behind which it is deepest, a few bits; 0 if that hides all
//! of a pixel, or if the light shines. If all corners of a cell are behind one caster, or behind what hides all of
//! the cell, so is its inside: casters with outlines of their own are convex.

/// Number of lights whose shadows are told apart: the first ones of the scene.
const MARKED_LIGHTS: usize = 3;
/// Number of lights that have a bit of their own in the sums of edges: sums of so many powers of two are exact in
/// any real type.
const LIGHT_BITS: usize = 20;
/// Number of bits that further lights share: few, so that the sum of three thousand lights is exact as well.
const SHARED_LIGHT_BITS: usize = 13;
/// Bits of the mark of a caster. Those of all lights together are exact in any real type.
const MARK_BITS: u32 = 5;
/// Bits of what is seen directly; those of what is seen in a mirror are above them.
const DIRECT_BITS: u32 = MARKED_LIGHTS as u32 * MARK_BITS;
/// The marks of what is seen directly.
pub const DIRECT_MARKS: u32 = (1 << DIRECT_BITS) - 1;

/// Returns what a light that shines adds to the sum of an edge. The lights whose shadows are noted have powers of two
/// of their own, below those of all further lights, so that no sum of the latter changes their bits.
#[inline(always)]
pub fn light_bit(light: usize) -> f64 {
    let bit = if light < LIGHT_BITS {
        light
    } else {
        shared_bit(light)
    };
    f64::from(1_u32 << bit)
}

/// Out of line: few scenes have so many lights, and the others are faster without it.
#[cold]
fn shared_bit(light: usize) -> usize {
    MARKED_LIGHTS + (light - LIGHT_BITS) % SHARED_LIGHT_BITS
}

/// Returns the mark that tells a caster from others, by its number: from 1 on.
#[inline(always)]
pub fn mark_of(number: usize) -> f64 {
    (number % ((1 << MARK_BITS) - 1) + 1) as f64
}

/// Returns the factor of the marks of casters before a light; `None` if its shadows are not told apart.
#[inline(always)]
pub fn weight_of(light: usize) -> Option<f64> {
    (light < MARKED_LIGHTS).then(|| f64::from(1_u32 << (light as u32 * MARK_BITS)))
}

/// Combines the shadows of a sample, which are sums of weighted marks: of what is seen directly and in its mirror.
#[inline(always)]
pub fn joined(direct: u32, mirrored: u32) -> u32 {
    direct | mirrored << DIRECT_BITS
}

/// Returns whether some light may shine into a cell between the shadows at its corners: all corners are in shadows
/// that end near them, and these are not all the same.
#[inline(always)]
pub fn may_leave_gap([a, b, c, d]: [u32; 4]) -> bool {
    let differing = (a ^ b) | (a ^ c) | (a ^ d);
    nonzero_marks(a)
        & nonzero_marks(b)
        & nonzero_marks(c)
        & nonzero_marks(d)
        & nonzero_marks(differing)
        != 0
}

/// Returns whether some light may shine into a cell between the shadows at two of its corners, while another corner is
/// lit: two corners are in different shadows that end near them.
#[inline(always)]
pub fn may_border_gap([a, b, c, d]: [u32; 4]) -> bool {
    let differ = |one: u32, other: u32| {
        nonzero_marks(one) & nonzero_marks(other) & nonzero_marks(one ^ other)
    };
    differ(a, b) | differ(a, c) | differ(a, d) | differ(b, c) | differ(b, d) | differ(c, d) != 0
}

/// Returns whether each of two lights shines at a corner where a shadow of the other ends nearby: between these
/// there may be light of both or of neither, and if the lights are equally bright, the corners look alike.
#[inline(always)]
pub fn may_swap_lights([a, b, c, d]: [u32; 4]) -> bool {
    let [a, b, c, d] = [
        nonzero_marks(a),
        nonzero_marks(b),
        nonzero_marks(c),
        nonzero_marks(d),
    ];
    let swapped = |one: u32, other: u32| one & !other != 0 && other & !one != 0;
    swapped(a, b) | swapped(a, c) | swapped(a, d) | swapped(b, c) | swapped(b, d) | swapped(c, d)
}

/// Returns, for each mark that is not zero, the highest bit of its field; all other bits are 0.
#[inline(always)]
fn nonzero_marks(shadows: u32) -> u32 {
    const HIGHEST_BITS: u32 = {
        let (mut bits, mut mark) = (0, 0);
        while mark < 2 * MARKED_LIGHTS {
            bits |= 1 << (mark as u32 * MARK_BITS + MARK_BITS - 1);
            mark += 1;
        }
        bits
    };
    const LOWER_BITS: u32 = HIGHEST_BITS - (HIGHEST_BITS >> (MARK_BITS - 1));
    (((shadows & LOWER_BITS) + LOWER_BITS) | shadows) & HIGHEST_BITS
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the shadows of a sample behind these casters of the first lights; `None` stands for no caster.
    fn behind(direct: &[Option<usize>], mirrored: &[Option<usize>]) -> u32 {
        let sum = |casters: &[Option<usize>]| {
            let marks = casters.iter().enumerate();
            let marks = marks.map(|(light, caster)| {
                caster.map_or(0.0, mark_of) * weight_of(light).expect("few lights")
            });
            marks.sum::<f64>() as f32 as u32
        };
        joined(sum(direct), sum(mirrored))
    }

    #[test]
    fn no_sum_of_other_lights_is_taken_for_one_that_is_told_apart() {
        let others: f64 = (MARKED_LIGHTS..3000).map(light_bit).sum();
        for marked in 0..MARKED_LIGHTS {
            let lit = (others + light_bit(marked)) as f32 as u32;
            let marked_bits: Vec<u32> = (0..MARKED_LIGHTS).map(|light| lit >> light & 1).collect();
            let expected: Vec<u32> = (0..MARKED_LIGHTS)
                .map(|light| u32::from(light == marked))
                .collect();
            assert_eq!(marked_bits, expected);
        }
    }

    #[test]
    fn gaps_are_between_different_shadows_of_one_light() {
        let last = Some(30);
        for light in 0..MARKED_LIGHTS {
            let of = |caster: Option<usize>| {
                let mut casters = [None; MARKED_LIGHTS];
                casters[light] = caster;
                casters
            };
            for in_mirror in [false, true] {
                let at = |casters: [Option<usize>; 4]| {
                    casters.map(|caster| {
                        if in_mirror {
                            behind(&[last, None, last], &of(caster))
                        } else {
                            behind(&of(caster), &[])
                        }
                    })
                };
                assert!(may_leave_gap(at([Some(0), Some(1), Some(0), Some(0)])));
                assert!(may_leave_gap(at([last, last, last, Some(29)])));
                assert!(!may_leave_gap(at([Some(0); 4])));
                assert!(!may_leave_gap(at([last; 4])));
                assert!(!may_leave_gap(at([None; 4])));
                let beside_light = at([Some(0), None, Some(1), Some(0)]);
                assert!(!may_leave_gap(beside_light) && may_border_gap(beside_light));
                assert!(!may_border_gap(at([Some(0), None, Some(0), None])));
            }
        }
        // Each of two lights shines at some corner.
        let (one, other) = (behind(&[Some(1), None], &[]), behind(&[None, Some(1)], &[]));
        assert!(!may_leave_gap([one, other, one, other]));
        assert!(may_swap_lights([one, other, one, other]));
        assert!(may_swap_lights([0, one, one | other, other]));
        assert!(!may_swap_lights([one | other, one, 0, 0]), "one by one");
        assert!(weight_of(MARKED_LIGHTS).is_none());
    }
}
