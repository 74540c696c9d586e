//! What a picture of a scene needs, and why: the plan in words, one entry per rule.

use std::collections::HashSet;

use serde::Serialize;

use super::geometry::{MAX_LIST, MAX_LISTED_OF_KIND, PlanCache, SMALLEST_TREE};
use super::materials::Material;
use super::pack::Plan;
use super::precision::{allows_finer_features, is_filtered, is_too_large_for_both, needs_double};
use super::request::RenderRequest;
use crate::scene::{Accelerator, HighlightMethod, Object, Precision, Sampling, Scene};
use crate::simd::Exponent;
use crate::words::counted;

/// The name of the rule for how primitives are found.
pub const ACCELERATOR: &str = "accelerator";

/// The reason for anything that the user has chosen.
const ASKED: &str = "it was requested";
/// The reason where formulas with known errors were requested.
const FAILING: &str =
    "formulas that are known to fail were requested, and their errors should be visible";

/// One decision of the plan.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Need {
    /// The name of its rule, for programs.
    pub rule: &'static str,
    /// What was decided.
    pub what: String,
    /// The property of the scene that decided it.
    pub why: String,
    /// What the decision saves.
    pub saves: String,
}

/// Returns the decisions of the plan for `request` of `scene`, which must pass [`crate::scene::check`].
pub fn needs(scene: &Scene, request: &RenderRequest) -> Vec<Need> {
    // Only the number of meshes matters, so their triangles are not packed.
    let plan = Plan::<f64>::new(&scene.abridged(), request, &mut PlanCache::default());
    vec![
        precision(scene, request),
        reflections(scene, &plan),
        shadows(scene, &plan),
        planes(&plan),
        markers(scene, &plan),
        hidden(scene),
        faces(&plan),
        accelerator(scene, request, &plan),
        normals(scene),
        highlights(scene, request, &plan),
        edges(request),
    ]
}

fn need(rule: &'static str, what: impl Into<String>, why: impl Into<String>, saves: &str) -> Need {
    Need {
        rule,
        what: what.into(),
        why: why.into(),
        saves: saves.to_owned(),
    }
}

fn precision(scene: &Scene, request: &RenderRequest) -> Need {
    let rule = "precision";
    let double = "double precision";
    match request.precision {
        Precision::Single => need(rule, "single precision", ASKED, "nothing more"),
        Precision::Double => need(rule, double, ASKED, "nothing"),
        Precision::Auto if needs_double(scene, request) => need(
            rule,
            double,
            "something is too far, too small or too close for single precision, or the lens is too long",
            "nothing: rounding would be visible in the picture",
        ),
        Precision::Auto if is_too_large_for_both(scene, request) => need(
            rule,
            double,
            "the scene is too large to keep in both precisions, which tracing doubtful samples again needs",
            "memory: both precisions need half as much again, and save no time",
        ),
        Precision::Auto => {
            let (what, saves) = if is_filtered(scene, request) {
                (
                    "single precision, and double where rounding might change what is visible",
                    "time: a vector holds twice as many numbers",
                )
            } else {
                (
                    "single precision",
                    "time: a vector holds twice as many numbers, and pixels on edges that rounding decides are not traced again",
                )
            };
            let why = if allows_finer_features(scene, request) {
                "no object is farther away than 500,000 of its radii or smaller than 1/1,000,000 of the scene"
            } else {
                "no object is farther away than 5,000 of its radii or smaller than 1/10,000 of the scene"
            };
            need(rule, what, why, saves)
        }
    }
}

fn reflections(scene: &Scene, plan: &Plan<f64>) -> Need {
    let rule = "reflections";
    let visible = || scene.visible_objects();
    let is_mirror = |object: &&Object| {
        let index = scene.color_packs.get_index_of(&object.color_pack);
        let surface = index.and_then(|index| plan.materials[index].surface.as_ref());
        surface.is_some_and(|surface| surface.mirror.is_some())
    };
    let mirrors = visible().filter(is_mirror).count();
    let limit = scene.render.reflection_limit;
    let none = |why: &str| {
        need(
            rule,
            "no reflected rays",
            why,
            "a ray and its shadow rays per hit on a mirror",
        )
    };
    if mirrors == 0 {
        none("no visible object reflects anything")
    } else if limit == 0 {
        none("the reflection limit is 0")
    } else {
        need(
            rule,
            format!("reflected rays, up to {}", counted(limit, "bounce")),
            format!(
                "{} reflect{}",
                counted(mirrors, "visible object"),
                if mirrors == 1 { "s" } else { "" }
            ),
            "one ray per hit serves all lights",
        )
    }
}

fn shadows(scene: &Scene, plan: &Plan<f64>) -> Need {
    let rule = "shadows";
    let (used, all) = (plan.lights.len(), scene.lights.len());
    let is_anything_seen = scene.visible_objects().next().is_some();
    if used == 0 || !is_anything_seen {
        let why = match all {
            0 => "there are no lights",
            _ if !is_anything_seen => "nothing is visible",
            _ => "every light is hidden, has no intensity or is behind a plane",
        };
        return need(rule, "no shadow rays", why, "all of them");
    }
    let why = if used == all {
        "every light may shine on something that is visible"
    } else {
        "the others are hidden, have no intensity or are behind a plane"
    };
    need(
        rule,
        format!(
            "shadow rays to {used} of {}, from surfaces that face them",
            counted(all, "light")
        ),
        why,
        "the shadow rays of surfaces that face away",
    )
}

fn planes(plan: &Plan<f64>) -> Need {
    let rule = "planes";
    match (plan.primitives.planes.len(), plan.planes_cast) {
        (0, _) => need(
            rule,
            "no planes",
            "there are none in the scene",
            "testing them for every ray",
        ),
        (number, true) => {
            let why = if plan.methods.is_sound() {
                "parallel rays start on both sides of a plane, or the camera lies in one"
            } else {
                FAILING
            };
            let what = format!("{} tested for shadows", counted(number, "plane"));
            need(rule, what, why, "nothing")
        }
        (number, false) => need(
            rule,
            format!("{} never tested for shadows", counted(number, "plane")),
            "everything visible is on the camera's side of every plane",
            "a test per plane and shadow ray",
        ),
    }
}

fn markers(scene: &Scene, plan: &Plan<f64>) -> Need {
    let rule = "markers";
    let drawn = plan.markers;
    let existing = scene
        .lights
        .iter()
        .filter(|light| light.marker.is_some())
        .count();
    if drawn > 0 {
        let what = format!(
            "{} drawn, never tested for shadows",
            counted(drawn, "light marker")
        );
        need(
            rule,
            what,
            "light markers are switched on",
            "a test per marker and shadow ray",
        )
    } else if existing > 0 {
        let what = format!("{} left out", counted(existing, "light marker"));
        need(
            rule,
            what,
            "they are switched off, or their lights are hidden",
            "a test per marker and ray",
        )
    } else {
        need(rule, "no light markers", "no light has one", "nothing")
    }
}

fn hidden(scene: &Scene) -> Need {
    let hidden = scene
        .objects
        .iter()
        .filter(|object| !object.visible)
        .count();
    if hidden == 0 {
        need("hidden", "every object drawn", "none is hidden", "nothing")
    } else {
        let what = format!("{} left out", counted(hidden, "object"));
        need(
            "hidden",
            what,
            "hidden in the outliner",
            "testing them for every ray",
        )
    }
}

fn faces(plan: &Plan<f64>) -> Need {
    let rule = "faces";
    let all = plan.primitives.triangles.len();
    let geometry = plan.geometry.as_ref();
    let in_tree = geometry.map_or(0, |geometry| geometry.primitives.triangles.len());
    if all == 0 && in_tree > 0 {
        let what = format!("both sides of {}", counted(in_tree, "triangle"));
        return need(rule, what, "rays find them in the tree", "nothing");
    }
    if all == 0 {
        let why = "there are none outside meshes, whose trees skip their far sides";
        return need(rule, "no single triangles", why, "nothing");
    }
    let count_set = |flags: &[bool]| flags.iter().filter(|flag| **flag).count();
    let unseen = count_set(&plan.camera_culled_faces);
    let unshadowing: usize = plan
        .lights
        .iter()
        .map(|light| count_set(&light.shadow_culled_faces))
        .sum();
    if unseen + unshadowing == 0 {
        let why = if plan.methods.is_tight() {
            "none belongs to a closed convex solid with the camera or a light outside"
        } else {
            FAILING
        };
        let what = format!("both sides of {}", counted(all, "triangle"));
        return need(rule, what, why, "nothing");
    }
    need(
        rule,
        format!(
            "{unseen} of {} left out for the camera, {unshadowing} of {} for {}",
            counted(all, "triangle"),
            all * plan.lights.len(),
            counted(plan.lights.len(), "light")
        ),
        "they are the far sides of closed convex solids",
        "a test per triangle and ray",
    )
}

fn accelerator(scene: &Scene, request: &RenderRequest, plan: &Plan<f64>) -> Need {
    let rule = ACCELERATOR;
    let faces: usize = scene.visible_objects().map(Object::faces).sum();
    let bounded = plan.bounded() + faces;
    if plan.screen.is_none() {
        return need(rule, "every primitive for every ray", FAILING, "nothing");
    }
    let what = counted(bounded, "bounded primitive");
    let asked = (request.accelerator != Accelerator::Auto).then(|| ASKED.to_owned());
    if request.accelerator == Accelerator::List && plan.geometry.is_some() {
        let what = format!("{what} one by one for every ray");
        return need(rule, what, ASKED, "nothing");
    }
    if plan.geometry.is_some() {
        let why = asked.unwrap_or_else(|| {
            format!(
                "meshes, more than {MAX_LIST} objects or {MAX_LISTED_OF_KIND} spheres or triangles, or fewer that fill a volume or share few pixels, are too many to list for every tile"
            )
        });
        need(
            rule,
            format!("{what} in a tree of boxes"),
            why,
            "time: it grows with what a ray comes near, not with the size of the scene",
        )
    } else {
        let why = asked.unwrap_or_else(|| {
            format!(
                "up to {SMALLEST_TREE}, or {MAX_LIST} side by side with many pixels each, are tested faster than a tree is traversed"
            )
        });
        need(
            rule,
            format!("{what} in a flat list, shortened for every tile"),
            why,
            "building a tree on every edit",
        )
    }
}

fn normals(scene: &Scene) -> Need {
    let rule = "normals";
    let is_smooth = |object: &&Object| object.is_smooth();
    match scene.visible_objects().filter(is_smooth).count() {
        0 => need(
            rule,
            "one normal per face",
            "no visible mesh is smooth",
            "interpolating three normals per face at every hit",
        ),
        smooth => need(
            rule,
            "normals interpolated between the corners of faces",
            format!("smooth meshes are visible: {smooth}"),
            "nothing: secondary rays start on the curved surface, so that its faces do not shadow it",
        ),
    }
}

fn highlights(scene: &Scene, request: &RenderRequest, plan: &Plan<f64>) -> Need {
    let rule = "highlights";
    // Highlights of unused color packs are never computed.
    let visible = scene.visible_objects();
    let used_packs: HashSet<&str> = visible.map(|object| &*object.color_pack).collect();
    let packs = plan.materials.iter().zip(scene.color_packs.keys());
    let surfaces = packs
        .filter(|(_, name)| used_packs.contains(name.as_str()))
        .filter_map(|(Material { surface, .. }, _)| surface.as_ref());
    let exponents: Vec<Exponent> = surfaces.filter_map(|surface| surface.exponent).collect();
    if exponents.is_empty() {
        need(
            rule,
            "no highlights",
            "no visible object has a specular colour",
            "computing their powers for every light",
        )
    } else if exponents
        .iter()
        .any(|exponent| matches!(exponent, Exponent::Large(_)))
    {
        let why = if request.methods.highlight == HighlightMethod::Log1p {
            ASKED
        } else {
            "an exponent is above 256, which would magnify the rounding of n·h"
        };
        need(
            rule,
            "exp(p·log1p(-w)) for large Phong exponents",
            why,
            "up to 43 levels of error at an exponent of 1,000,000",
        )
    } else if exponents
        .iter()
        .any(|exponent| matches!(exponent, Exponent::Mixed(..)))
    {
        need(
            rule,
            "squaring, and a logarithm for fractions",
            "an exponent is not a whole number",
            "nothing",
        )
    } else {
        let why = if request.methods.highlight == HighlightMethod::Power {
            ASKED
        } else {
            "every Phong exponent is a whole number up to 256"
        };
        need(
            rule,
            "repeated squaring",
            why,
            "a logarithm and an exponential per light",
        )
    }
}

fn edges(request: &RenderRequest) -> Need {
    let rule = "edges";
    match request.sampling {
        Sampling::Centres => need(
            rule,
            "one ray per pixel",
            "antialiasing is off",
            "all additional rays",
        ),
        Sampling::Grid(side) => need(
            rule,
            format!("{side}×{side} rays per pixel"),
            "a grid was requested",
            "nothing",
        ),
        Sampling::Adaptive { .. } => need(
            rule,
            "more rays only where corners differ or something thin is near",
            "elsewhere a pixel is the mean of its corners",
            "most of the rays of an equally accurate grid",
        ),
    }
}
