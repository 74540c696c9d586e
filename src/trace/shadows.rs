//! Which shadows samples are in that end near them: between two of them a pixel may be lit whose corners are all dark,
//! and between those of two lights there may be light of both or of neither.
//!
//! A sample notes for each light the caster that it is deepest behind, as a few bits; nothing if that hides all of a
//! pixel, or if the light shines. Where all corners of a cell are behind one caster or behind what hides it all, so
//! is its inside: casters with outlines of their own are convex.

/// Lights that are told apart: the first of the scene.
const LIGHTS: usize = 3;
/// Lights that an edge tells apart: sums of so many powers of two are exact in any real type.
const LIGHT_BITS: usize = 20;
/// Bits that more lights share: few, so that the sum of three thousand lights is exact as well.
const SHARED: usize = 13;
/// Bits that tell casters apart. Those of all lights together are exact in any real type.
const BITS: u32 = 5;
/// Bits of what is seen directly; above them are those of what is seen in a mirror.
const DIRECT: u32 = LIGHTS as u32 * BITS;

/// What an edge adds for a light that shines. Those that shadows are noted of have a power of two of their own; no sum
/// of the others reaches down to it.
#[inline(always)]
pub fn light_bit(light: usize) -> f64 {
    let place = if light < LIGHT_BITS {
        light
    } else {
        shared_bit(light)
    };
    f64::from(1_u32 << place)
}

/// Apart: few scenes have so many lights, and the others are quicker without.
#[cold]
fn shared_bit(light: usize) -> usize {
    LIGHTS + (light - LIGHT_BITS) % SHARED
}

/// What tells a caster from others, by its number: from 1 on.
#[inline(always)]
pub fn mark_of(number: usize) -> f64 {
    (number % ((1 << BITS) - 1) + 1) as f64
}

/// What the mark of a caster before a light is multiplied by; `None` for lights that are not told apart.
#[inline(always)]
pub fn weight_of(light: usize) -> Option<f64> {
    (light < LIGHTS).then(|| f64::from(1_u32 << (light as u32 * BITS)))
}

/// The shadows of a sample: sums of weighted marks, of what is seen directly and of what is seen in its mirror.
#[inline(always)]
pub fn joined(direct: u32, mirrored: u32) -> u32 {
    direct | mirrored << DIRECT
}

/// Whether some light may shine into a cell between the shadows at its corners: all of them end near there, and they
/// are not all the same.
#[inline(always)]
pub fn may_leave_gap([a, b, c, d]: [u32; 4]) -> bool {
    let differing = (a ^ b) | (a ^ c) | (a ^ d);
    noted(a) & noted(b) & noted(c) & noted(d) & noted(differing) != 0
}

/// Whether each of two lights shines at a corner where the shadow of the other ends nearby: between those there may be
/// light of both or of neither, and if they are as bright, the corners look alike.
#[inline(always)]
pub fn may_swap_lights([a, b, c, d]: [u32; 4]) -> bool {
    let [a, b, c, d] = [noted(a), noted(b), noted(c), noted(d)];
    let swapped = |one: u32, other: u32| one & !other != 0 && other & !one != 0;
    swapped(a, b) | swapped(a, c) | swapped(a, d) | swapped(b, c) | swapped(b, d) | swapped(c, d)
}

/// The highest bit of each mark that is not zero.
#[inline(always)]
fn noted(shadows: u32) -> u32 {
    const HIGHEST: u32 = {
        let (mut bits, mut mark) = (0, 0);
        while mark < 2 * LIGHTS {
            bits |= 1 << (mark as u32 * BITS + BITS - 1);
            mark += 1;
        }
        bits
    };
    const OTHERS: u32 = HIGHEST - (HIGHEST >> (BITS - 1));
    (((shadows & OTHERS) + OTHERS) | shadows) & HIGHEST
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The shadows of a sample behind such casters of the first lights, none where there is none.
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
        let others: f64 = (LIGHTS..3000).map(light_bit).sum();
        for own in 0..LIGHTS {
            let lit = (others + light_bit(own)) as f32 as u32;
            let told: Vec<u32> = (0..LIGHTS).map(|light| lit >> light & 1).collect();
            let expected: Vec<u32> = (0..LIGHTS).map(|light| u32::from(light == own)).collect();
            assert_eq!(told, expected);
        }
    }

    #[test]
    fn gaps_are_between_different_shadows_of_one_light() {
        let last = Some(30);
        for light in 0..LIGHTS {
            let of = |caster: Option<usize>| {
                let mut casters = [None; LIGHTS];
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
                assert!(!may_leave_gap(at([Some(0), None, Some(1), Some(2)])), "lit");
            }
        }
        // Each of two lights shines at some corner.
        let (one, other) = (behind(&[Some(1), None], &[]), behind(&[None, Some(1)], &[]));
        assert!(!may_leave_gap([one, other, one, other]));
        assert!(may_swap_lights([one, other, one, other]));
        assert!(may_swap_lights([0, one, one | other, other]));
        assert!(!may_swap_lights([one | other, one, 0, 0]), "one by one");
        assert!(weight_of(LIGHTS).is_none());
    }
}
