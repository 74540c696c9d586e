//! Colour packs, made ready for shading.

use glam::DVec3;

use super::request::{Model, RenderRequest};
use crate::scene::{ColorPack, HighlightMethod, Scene};
use crate::simd::{Exponent, Real, Vec3};

/// A material with everything multiplied in that is the same for all its points. Colours are 0–1.
#[derive(Clone, Copy, Debug)]
pub struct Material<R> {
    /// What is seen without any light: ambient intensity · ambient, or the full ambient colour of a
    /// marker.
    pub base: Vec3<R>,
    /// How lights and mirrored things add to it; `None` for markers and for packs that are black
    /// in both.
    pub surface: Option<Surface<R>>,
}

/// The part of a material that answers to light.
#[derive(Clone, Copy, Debug)]
pub struct Surface<R> {
    /// Matte colour.
    pub diffuse: Vec3<R>,
    /// Highlight colour.
    pub specular: Vec3<R>,
    /// Sharpness of the highlight; `None` where there is none.
    pub exponent: Option<Exponent>,
    /// (Σ intensities) · specular, the filter of the mirror image; `None` where there is none.
    pub mirror: Option<Vec3<R>>,
}

impl<R: Real> Surface<R> {
    /// How wide the highlight is, if it may be smaller than a pixel; see [`Exponent::size`].
    pub fn size_of_highlight(&self) -> Option<f64> {
        self.exponent.and_then(Exponent::size)
    }

    /// The sum of the channels of the matte colour.
    pub fn brightness(&self) -> R {
        self.diffuse.x + self.diffuse.y + self.diffuse.z
    }

    /// The sum of the channels of the highlight's colour.
    pub fn gloss(&self) -> R {
        self.specular.x + self.specular.y + self.specular.z
    }
}

/// One material per pack, then one per pack as a marker wears it.
pub fn pack_materials<R: Real>(scene: &Scene, request: &RenderRequest) -> Vec<Material<R>> {
    let lights = scene.visible_lights();
    let total_intensity: f64 = lights.map(|light| light.intensity).sum();
    let lit = scene.color_packs.values().map(|pack| Material {
        base: linear(pack.ambient * scene.ambient_intensity),
        surface: pack_surface(pack, total_intensity, request),
    });
    let markers = scene.color_packs.values().map(|pack| Material {
        base: linear(pack.ambient),
        surface: None,
    });
    lit.chain(markers).collect()
}

fn pack_surface<R: Real>(
    pack: &ColorPack,
    total_intensity: f64,
    request: &RenderRequest,
) -> Option<Surface<R>> {
    let all = request.model == Model::Everything;
    let shines = pack.specular.abs().max_element() > 0.0;
    let mirrors = pack.reflective && (all || shines && total_intensity > 0.0);
    (all || shines || pack.diffuse.abs().max_element() > 0.0).then(|| Surface {
        diffuse: linear(pack.diffuse),
        specular: linear(pack.specular),
        exponent: (all || shines).then(|| exponent(request.methods.highlight, pack.phong_exponent)),
        mirror: mirrors.then(|| linear(pack.specular * total_intensity)),
    })
}

/// How an exponent is raised to by a method.
pub fn exponent(method: HighlightMethod, exponent: f64) -> Exponent {
    match method {
        HighlightMethod::Auto => Exponent::new(exponent),
        HighlightMethod::Power => Exponent::power(exponent),
        HighlightMethod::Log1p => Exponent::Large(exponent),
    }
}

/// 0–255 to 0–1.
pub fn linear<R: Real>(color: DVec3) -> Vec3<R> {
    Vec3::from_dvec3(color * (1.0 / 255.0))
}
