//! Views of a single part of the shading: scenes in which all other terms are zero.

use glam::DVec3;

use super::material::ColorPack;
use super::whole::Scene;

/// The part of the shading that is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Aspect {
    /// The normal picture.
    #[default]
    All,
    /// The ambient term alone.
    Ambient,
    /// The diffuse terms of the lights.
    Diffuse,
    /// The specular highlights of the lights.
    Specular,
    /// The normal picture without reflections.
    WithoutMirrors,
    /// Shapes and shadows in uniform grey.
    Clay,
    /// Each object in its own colour, without lighting.
    Objects,
    /// Surface normals.
    Normals,
    /// Distance from the camera.
    Depth,
    /// Which lights reach each point.
    Shadows,
    /// Reflections alone.
    Mirrors,
    /// Number of rays per pixel, averaged over blocks of 8 × 8 pixels.
    Cost,
    /// Samples that are traced again in double precision.
    Again,
}

/// Golden angle in turns: steps of this size give neighbouring objects the most distinct hues.
const GOLDEN: f64 = 0.381_966_011_250_105;
/// Grey level of [`Aspect::Clay`], 0–255.
const CLAY: f64 = 200.0;

impl Aspect {
    /// All aspects, each with its name and a description.
    pub const EACH: [(Self, &'static str, &'static str); 13] = [
        (Self::All, "Everything", "The picture as it is"),
        (
            Self::Ambient,
            "Ambient only",
            "Ambient intensity · ambient colour: what is seen without any light",
        ),
        (
            Self::Diffuse,
            "Diffuse only",
            "Each light: intensity · diffuse colour · cosine of the angle to it",
        ),
        (
            Self::Specular,
            "Specular only",
            "Each light: intensity · specular colour · highlight; no mirror reflections",
        ),
        (
            Self::WithoutMirrors,
            "Without mirrors",
            "Everything except mirror reflections",
        ),
        (Self::Clay, "Clay", "Shapes and shadows, all in one grey"),
        (Self::Objects, "Objects", "Each object in its own colour"),
        (
            Self::Normals,
            "Normals",
            "Which way surfaces face: x, y and z from -1 to 1 as red, green and blue",
        ),
        (
            Self::Depth,
            "Depth",
            "Distance from the camera: white where the scene begins, black where it ends",
        ),
        (
            Self::Shadows,
            "Shadows only",
            "How many of the lights reach each point: white is all of them",
        ),
        (
            Self::Mirrors,
            "Mirrors only",
            "What mirror reflections add to their surfaces",
        ),
        (
            Self::Cost,
            "Rays per pixel",
            "Rays per pixel, averaged over squares of 8 pixels: black is 1, white 1,000",
        ),
        (
            Self::Again,
            "Traced again",
            "Samples that are traced again in double precision, since rounding might change them: white, in a dark picture",
        ),
    ];

    /// The name in the user interface.
    pub fn name(self) -> &'static str {
        self.words_of().0
    }

    /// A phrase that describes what is shown.
    pub fn meaning(self) -> &'static str {
        self.words_of().1
    }

    fn words_of(self) -> (&'static str, &'static str) {
        let mut all = Self::EACH.iter();
        all.find(|(aspect, ..)| *aspect == self)
            .map_or(("", ""), |(_, name, meaning)| (name, meaning))
    }

    /// The name on the command line.
    pub fn word(self) -> String {
        let name = self.name().to_lowercase();
        name.strip_suffix(" only")
            .unwrap_or(&name)
            .replace(' ', "-")
    }

    /// All names on the command line, separated by commas.
    pub fn words() -> String {
        Self::EACH.map(|(aspect, ..)| aspect.word()).join(", ")
    }

    /// Returns the scene whose normal picture shows this aspect of `scene`.
    #[must_use]
    pub fn of(self, scene: &Scene) -> Scene {
        let mut shown = scene.clone();
        let change = |shown: &mut Scene, change: fn(&mut ColorPack)| {
            shown.packs_mut().values_mut().for_each(change);
        };
        match self {
            Self::All | Self::Mirrors | Self::Cost | Self::Again => {}
            Self::Normals | Self::Depth => unlit(&mut shown),
            Self::Shadows => {
                clay(&mut shown);
                shown.background = DVec3::ZERO;
                shown.ambient_intensity = 0.0;
                let lights = shown.lights.iter_mut();
                // Lights of zero intensity cast no shadows.
                for light in lights.filter(|light| light.intensity > 0.0) {
                    light.intensity = 1.0;
                }
            }
            Self::Ambient => darken(&mut shown),
            Self::Diffuse => {
                shown.ambient_intensity = 0.0;
                change(&mut shown, |pack| pack.specular = DVec3::ZERO);
            }
            Self::Specular => {
                shown.ambient_intensity = 0.0;
                change(&mut shown, |pack| {
                    pack.diffuse = DVec3::ZERO;
                    pack.reflective = false;
                });
            }
            Self::WithoutMirrors => change(&mut shown, |pack| pack.reflective = false),
            Self::Clay => clay(&mut shown),
            Self::Objects => flat(&mut shown),
        }
        shown
    }
}

/// Makes every color pack the same matte grey.
fn clay(shown: &mut Scene) {
    for pack in shown.packs_mut().values_mut() {
        *pack = ColorPack {
            ambient: DVec3::splat(CLAY),
            diffuse: DVec3::splat(CLAY),
            specular: DVec3::ZERO,
            reflective: false,
            ..pack.clone()
        };
    }
}

/// Sets the intensity of all lights to zero.
fn darken(shown: &mut Scene) {
    for light in shown.lights.iter_mut() {
        light.intensity = 0.0;
    }
}

/// Removes all lights, the background and reflections.
fn unlit(shown: &mut Scene) {
    darken(shown);
    shown.background = DVec3::ZERO;
    for pack in shown.packs_mut().values_mut() {
        pack.reflective = false;
    }
}

/// Gives each object its own colour, independent of lighting.
fn flat(shown: &mut Scene) {
    darken(shown);
    shown.ambient_intensity = 1.0;
    let mut word = "object".to_owned();
    while shown.color_packs.keys().any(|name| name.starts_with(&word)) {
        word.push('+');
    }
    let names: Vec<String> = (0..shown.objects.len())
        .map(|index| format!("{word} {index}"))
        .collect();
    for (object, name) in shown.objects.iter_mut().zip(&names) {
        object.color_pack.clone_from(name);
    }
    for (index, name) in names.into_iter().enumerate() {
        let pack = ColorPack {
            ambient: hue(index as f64 * GOLDEN),
            ..ColorPack::default()
        };
        shown.packs_mut().insert(name, pack);
    }
}

/// Returns a light colour with a hue given in turns.
fn hue(turns: f64) -> DVec3 {
    let channel = |off: f64| {
        let wave = ((turns + off).fract() * 6.0 - 3.0).abs() - 1.0;
        70.0 + 180.0 * wave.clamp(0.0, 1.0)
    };
    DVec3::new(channel(0.0), channel(2.0 / 3.0), channel(1.0 / 3.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::render;
    use crate::plan::RenderRequest;
    use crate::scene::check;
    use crate::trace::RenderControl;

    #[test]
    fn every_aspect_of_the_demo_is_a_valid_scene_of_its_own() {
        let demo = Scene::demo();
        assert_eq!(Aspect::All.of(&demo), demo);
        for (aspect, name, _) in &Aspect::EACH[1..] {
            let shown = aspect.of(&demo);
            // These aspects are produced by the tracer, from an unchanged scene.
            let is_traced = matches!(aspect, Aspect::Mirrors | Aspect::Cost | Aspect::Again);
            assert_eq!(shown == demo, is_traced, "{name}");
            assert_eq!(check(&shown), Ok(()), "{name}");
        }
    }

    #[test]
    fn words_are_short() {
        assert_eq!(
            Aspect::words(),
            "everything, ambient, diffuse, specular, without-mirrors, clay, objects, normals, depth, shadows, mirrors, rays-per-pixel, traced-again"
        );
    }

    /// The three terms add up to the whole, per 8-bit channel, capped at 255 and within rounding.
    #[test]
    fn the_terms_of_the_demo_add_up_to_its_picture_without_mirrors() {
        let demo = Scene::demo();
        let picture = |aspect: Aspect| {
            let request = RenderRequest::sized(48, 48);
            let shown = aspect.of(&demo);
            let picture = render(&shown, &request, &RenderControl::default());
            picture.expect("nobody stops it").0.pixels
        };
        let parts = [Aspect::Ambient, Aspect::Diffuse, Aspect::Specular].map(picture);
        let whole = picture(Aspect::WithoutMirrors);
        for (n, whole) in whole.iter().enumerate() {
            for channel in 0..3 {
                // Markers are visible in every aspect.
                let parts = parts.each_ref().map(|part| u32::from(part[n][channel]));
                let sum = parts.iter().sum::<u32>().min(255);
                let whole = u32::from(whole[channel]);
                let is_marker = parts.iter().all(|part| *part == whole);
                assert!(
                    is_marker || sum.abs_diff(whole) <= 2,
                    "{n}: {parts:?} {whole}"
                );
            }
        }
    }
}
