//! Subjects of the maps.

use glam::DVec3;

use crate::animate::motion_between;
use crate::scene::{Method as _, Orientation, Scene, Shape};

/// The subject of a map, which determines the setting that it tests and the position of a scene on its axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapSubject {
    /// Rays that hit or pass spheres.
    Sphere,
    /// Rays at the edges of triangles.
    Triangle,
    /// Lit points of single shapes that are taken for shadowed.
    ShadowAcne,
    /// Shadowed points of single shapes that are taken for lit.
    ShadowLeak,
    /// Lit points of meshes that are taken for shadowed.
    MeshAcne,
    /// Shadowed points of meshes that are taken for lit.
    MeshLeak,
    /// Coincident surfaces.
    Coincident,
    /// Pixels that rounding decides.
    Rounding,
    /// The terminator on smoothly shaded meshes.
    Terminator,
    /// Things thinner than a pixel.
    Thin,
    /// Phong highlights.
    Highlight,
    /// Rays that graze planes.
    Plane,
    /// Rays close to the rims of discs.
    Disc,
    /// Cameras that look nearly straight up.
    CameraPole,
    /// Cameras after many turns.
    CameraTurns,
    /// Paths through unevenly spaced keys.
    Path,
    /// Rotations between keys.
    Turn,
    /// Fingerprints of exported frames.
    Fingerprint,
}

impl MapSubject {
    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sphere => "sphere",
            Self::Triangle => "triangle",
            Self::ShadowAcne => "shadow acne",
            Self::ShadowLeak => "shadow leak",
            Self::MeshAcne => "mesh acne",
            Self::MeshLeak => "mesh leak",
            Self::Coincident => "surfaces in one place",
            Self::Rounding => "decided by rounding",
            Self::Terminator => "smooth terminator",
            Self::Thin => "thin things",
            Self::Highlight => "highlight",
            Self::Plane => "plane",
            Self::Disc => "disc",
            Self::CameraPole => "camera at the pole",
            Self::CameraTurns => "camera after turns",
            Self::Path => "path between keys",
            Self::Turn => "turn between keys",
            Self::Fingerprint => "export fingerprint",
        }
    }

    /// Returns whether it is tested in single precision only.
    pub fn is_of_single_precision(self) -> bool {
        matches!(
            self,
            Self::Sphere | Self::Triangle | Self::Highlight | Self::Disc
        )
    }

    /// The id of the method that the settings choose; `None` if there is no choice.
    pub fn method_in_use(self, scene: &Scene) -> Option<String> {
        let render = &scene.render;
        match self {
            Self::Sphere => Some(render.sphere.id()),
            Self::Triangle => Some(render.triangle.id()),
            Self::Highlight => Some(render.specular.id()),
            Self::Rounding => Some(render.precision.id()),
            Self::Thin => Some(render.antialias.id()),
            Self::ShadowAcne | Self::ShadowLeak | Self::MeshAcne | Self::MeshLeak => {
                Some(render.offset.id())
            }
            _ => None,
        }
    }

    /// The position of a scene on the axes of the map; `None` if there is none.
    pub fn scene_position(self, scene: &Scene) -> Option<(f64, f64)> {
        match self {
            Self::Sphere | Self::Disc => self.farthest(scene),
            Self::Highlight => {
                let packs = scene.packs_in_use();
                let exponents = packs.map(|(_, pack)| pack.phong_exponent);
                let sharpest = exponents.max_by(f64::total_cmp)?;
                Some((sharpest, 1.0))
            }
            Self::Terminator
            | Self::Coincident
            | Self::Rounding
            | Self::Thin
            | Self::Plane
            | Self::CameraTurns
            | Self::Fingerprint => None,
            Self::CameraPole => {
                let pitch = Orientation::of(&scene.camera).pitch.to_degrees();
                Some((90.0 - pitch.abs(), 1.0))
            }
            Self::Turn => {
                let keys = scene.animation.keys.windows(2);
                let turns = keys.map(|pair| motion_between(&pair[0].value, &pair[1].value).turn);
                turns.max_by(f64::total_cmp).map(|turn| (turn, 1.0))
            }
            Self::Path => {
                let keys = scene.animation.keys.windows(2);
                let lengths =
                    keys.map(|pair| (pair[1].value.position - pair[0].value.position).length());
                let lengths: Vec<f64> = lengths.filter(|length| *length > 0.0).collect();
                let ratio = |pair: &[f64]| (pair[0] / pair[1]).max(pair[1] / pair[0]);
                let ratios = lengths.windows(2).map(ratio);
                ratios.max_by(f64::total_cmp).map(|ratio| (ratio, 1.0))
            }
            // The plan moves every scene to the origin before it is traced.
            Self::Triangle => middle_and_size(scene).map(|(_, size)| (0.0, size)),
            Self::ShadowAcne | Self::ShadowLeak | Self::MeshAcne | Self::MeshLeak => {
                middle_and_size(scene).map(|(middle, size)| (middle.length() / size, size))
            }
        }
    }

    /// Distance in radii, and radius, of the sphere or disc that is farthest from the eye relative to its radius.
    fn farthest(self, scene: &Scene) -> Option<(f64, f64)> {
        let eye = scene.camera.position;
        let round = scene.visible_objects().filter_map(|object| {
            let (center, radius) = match (&object.shape, self) {
                (Shape::Sphere(sphere), Self::Sphere) => (sphere.center, sphere.radius),
                (Shape::Disc(disc), Self::Disc) => (disc.center, disc.radius),
                _ => return None,
            };
            Some(((center - eye).length() / radius, radius))
        });
        round.max_by(|a, b| a.0.total_cmp(&b.0))
    }
}

/// Centre and half diagonal of the bounding box of everything visible and finite.
fn middle_and_size(scene: &Scene) -> Option<(DVec3, f64)> {
    let (low, high) = scene.bounds()?;
    Some((low.midpoint(high), (high - low).length() / 2.0))
}
