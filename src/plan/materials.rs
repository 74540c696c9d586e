//! Color packs prepared for shading.

use glam::DVec3;

use super::request::{Model, RenderRequest};
use crate::scene::{ColorPack, HighlightMethod, Scene};
use crate::simd::{Exponent, Real, Vec3};

/// A material, with all factors multiplied in that are the same at each of its points. Colours are 0–1.
#[derive(Clone, Copy, Debug)]
pub struct Material<R> {
    /// Colour without any light: ambient intensity · ambient, or the full ambient colour of a marker.
    pub base: Vec3<R>,
    /// How lights and mirror images add to it; `None` for markers and for packs in which both the diffuse and the
    /// specular colour are black.
    pub surface: Option<Surface<R>>,
}

/// The part of a material that responds to light.
#[derive(Clone, Copy, Debug)]
pub struct Surface<R> {
    /// Diffuse colour.
    pub diffuse: Vec3<R>,
    /// Specular colour.
    pub specular: Vec3<R>,
    /// Phong exponent of the highlight; `None` without a highlight.
    pub exponent: Option<Exponent>,
    /// (Σ intensities) · specular, the factor of the mirror image; `None` without one.
    pub mirror: Option<Vec3<R>>,
}

impl<R: Real> Surface<R> {
    /// The size of the highlight, if it may be smaller than a pixel; see [`Exponent::size`].
    pub fn size_of_highlight(&self) -> Option<f64> {
        self.exponent.and_then(Exponent::size)
    }

    /// The sum of the channels of the diffuse colour.
    pub fn brightness(&self) -> R {
        self.diffuse.x + self.diffuse.y + self.diffuse.z
    }

    /// The sum of the channels of the specular colour.
    pub fn gloss(&self) -> R {
        self.specular.x + self.specular.y + self.specular.z
    }
}

/// One material per color pack, then one per color pack as used by markers.
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

/// The form in which a method computes powers with this exponent.
pub fn exponent(method: HighlightMethod, exponent: f64) -> Exponent {
    match method {
        HighlightMethod::Auto => Exponent::new(exponent),
        HighlightMethod::Power => Exponent::power(exponent),
        HighlightMethod::Log1p => Exponent::Large(exponent),
    }
}

/// Converts a colour from 0–255 to 0–1.
pub fn linear<R: Real>(color: DVec3) -> Vec3<R> {
    Vec3::from_dvec3(color * (1.0 / 255.0))
}
