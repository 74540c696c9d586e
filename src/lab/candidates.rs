//! The ways of tracing a picture that are compared.

use crate::plan::{Model, RenderRequest};
use crate::scene::{
    HighlightMethod, MAX_REFLECTIONS, Method, Precision, RayOffset, Render, Sampling, Scene,
    Setting, SphereMethod, TriangleMethod, VisitSetting,
};
use crate::words::counted;

/// The kind of difference between a way of tracing and the plan's choice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Family {
    /// The number and places of samples, and the depth of reflections.
    Sampling,
    /// The formulas, and the search for primitives.
    Formulas,
    /// The floating-point type.
    Precision,
    /// The size of the traced picture.
    Resolution,
    /// Everything: the original program, from which this one grew.
    Original,
    /// Everything: another engine draws the picture.
    Referee,
}

impl Family {
    /// All kinds, with their names.
    pub const ALL: [(Self, &'static str); 6] = [
        (Self::Sampling, "sampling"),
        (Self::Formulas, "formulas"),
        (Self::Precision, "precision"),
        (Self::Resolution, "resolution"),
        (Self::Original, "the original program"),
        (Self::Referee, "independent renderer"),
    ];
}

/// One way of tracing a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// Its name in the chart.
    pub name: String,
    /// How it differs from the plan's choice.
    pub family: Family,
    /// Its settings. Width and height are those of the finished picture.
    pub render: Render,
    /// Which parts of the model are left out because the scene does not need them.
    pub model: Model,
    /// Factor by which each side of the traced picture is smaller; the picture is then scaled up.
    pub upscale: u32,
}

/// Name of the scene's own settings.
pub const OWN_SETTINGS: &str = "this scene";
/// Name of the other engine.
pub const POVRAY: &str = "POV-Ray";

/// Name of the plan's choice with every primitive tested for every ray. Sphere formulas are compared with this:
/// culling would hide hits where there is no sphere.
pub const UNCULLED: &str = "no culling";

/// Samples along each side of a pixel of the plain grids.
const GRIDS: [u32; 7] = [2, 3, 4, 6, 8, 12, 16];
/// Contrasts and depths of the adaptive samplings other than the default one.
const ADAPTIVE: [(f64, u32); 5] = [(0.3, 1), (0.1, 1), (0.3, 3), (0.1, 2), (0.03, 3)];

/// The plain samplings, then the adaptive ones other than the default.
fn sampling_ladder() -> impl Iterator<Item = Sampling> {
    std::iter::once(Sampling::Centres)
        .chain(GRIDS.map(Sampling::Grid))
        .chain(ADAPTIVE.map(|(contrast, depth)| Sampling::Adaptive { contrast, depth }))
}

/// All samplings that are compared: grids by size, the default one last.
pub fn samplings() -> impl Iterator<Item = Sampling> {
    sampling_ladder().chain([Sampling::ADAPTIVE])
}

/// The ways of tracing `scene` in `width × height` pixels: the plan's choice first; the scene's own settings, if they
/// differ; the original program; everything that differs from the plan's choice in one setting; and the ladder of
/// samplings.
pub fn candidates(scene: &Scene, width: u32, height: u32) -> Vec<Candidate> {
    let plan = Candidate {
        name: "the plan".to_owned(),
        family: Family::Sampling,
        render: Render {
            width,
            height,
            reflection_limit: scene.render.reflection_limit,
            ..Render::default()
        },
        model: Model::Needed,
        upscale: 1,
    };
    let mut all = vec![plan.clone()];
    let settings = Render {
        width,
        height,
        ..scene.render.clone()
    };
    if settings != plan.render {
        let sampled_alike = Render {
            antialias: plan.render.antialias,
            ..settings.clone()
        };
        let family = match settings.precision == plan.render.precision {
            true if sampled_alike == plan.render => Family::Sampling,
            true => Family::Formulas,
            false => Family::Precision,
        };
        all.push(Candidate {
            name: OWN_SETTINGS.to_owned(),
            family,
            render: settings,
            ..plan.clone()
        });
    }
    all.push(Candidate {
        name: "the original program".to_owned(),
        family: Family::Original,
        render: Render {
            antialias: Sampling::Centres,
            precision: Precision::Single,
            sphere: SphereMethod::Classic,
            triangle: TriangleMethod::Edges,
            offset: RayOffset::Fixed(0.1),
            specular: HighlightMethod::Power,
            ..plan.render.clone()
        },
        model: Model::Everything,
        upscale: 1,
    });
    let mut change = |name: String, family: Family, change: &dyn Fn(&mut Render)| {
        let mut candidate = plan.clone();
        (candidate.name, candidate.family) = (name, family);
        change(&mut candidate.render);
        all.push(candidate);
    };
    // Every method of every setting other than the plan's; samplings follow in the ladder below.
    for (name, render) in neighbours(&plan.render) {
        let family = if render.precision == plan.render.precision {
            Family::Formulas
        } else {
            Family::Precision
        };
        change(name, family, &|settings| *settings = render.clone());
    }
    let limit = scene.render.reflection_limit;
    if limit > 0 {
        change(counted(limit - 1, "bounce"), Family::Sampling, &|render| {
            render.reflection_limit = limit - 1;
        });
    }
    if limit < MAX_REFLECTIONS {
        change(counted(limit + 1, "bounce"), Family::Sampling, &|render| {
            render.reflection_limit = limit + 1;
        });
    }
    for sampling in sampling_ladder() {
        change(sampling.id(), Family::Sampling, &|render| {
            render.antialias = sampling;
        });
    }
    change("none, f64".to_owned(), Family::Precision, &|render| {
        render.antialias = Sampling::Centres;
        render.precision = Precision::Double;
    });
    all.push(Candidate {
        name: UNCULLED.to_owned(),
        family: Family::Formulas,
        model: Model::Unculled,
        ..plan.clone()
    });
    for upscale in [2, 4] {
        all.push(Candidate {
            name: format!("1/{upscale} size"),
            family: Family::Resolution,
            upscale,
            ..plan.clone()
        });
    }
    all
}

/// An independent engine, for comparison.
pub fn povray(scene: &Scene, width: u32, height: u32) -> Candidate {
    Candidate {
        name: POVRAY.to_owned(),
        family: Family::Referee,
        render: Render {
            width,
            height,
            antialias: Sampling::Centres,
            precision: Precision::Double,
            ..scene.render.clone()
        },
        model: Model::Needed,
        upscale: 1,
    }
}

/// Settings that differ from `render` in one formula, with their names.
fn neighbours(render: &Render) -> Vec<(String, Render)> {
    let mut list = MethodList(Vec::new());
    render.clone().visit_settings(&mut list);
    let formulas = list
        .0
        .iter()
        .filter(|(setting, ..)| setting.name != "antialias");
    let neighbours = formulas.map(|(setting, id)| {
        let mut neighbour = render.clone();
        neighbour.choose(setting.name, id);
        (format!("{}{id}", setting.prefix), neighbour)
    });
    neighbours.collect()
}

/// Every method of every setting except the defaults.
struct MethodList(Vec<(Setting, &'static str)>);

impl VisitSetting for MethodList {
    fn visit<M: Method>(&mut self, setting: Setting, _value: &mut M) {
        let others = M::ALL[1..].iter();
        self.0.extend(others.map(|method| (setting, method.id)));
    }
}

impl Candidate {
    /// The request for the picture that is traced, before it is scaled up.
    pub fn request(&self, scene: &Scene) -> RenderRequest {
        let side = |side: u32| side.div_ceil(self.upscale);
        let (width, height) = (side(self.render.width), side(self.render.height));
        RenderRequest {
            model: self.model,
            ..RenderRequest::of(&self.scene(scene), width, height)
        }
    }

    /// The scene with the candidate's settings.
    pub fn scene(&self, scene: &Scene) -> Scene {
        Scene {
            render: self.render.clone(),
            ..scene.clone()
        }
    }

    /// Its settings, in the words of the command line.
    pub fn words(&self) -> String {
        if self.family == Family::Referee {
            return "one ray per pixel, double precision; time to start and to read the scene is not counted".to_owned();
        }
        let chosen = self.render.chosen().into_iter();
        let ids = chosen.map(|chosen| format!("{} {}", chosen.setting.name, chosen.id));
        let mut words: Vec<String> = ids.collect();
        words.push(counted(self.render.reflection_limit, "bounce"));
        match self.model {
            Model::Everything => words.push("nothing left out".to_owned()),
            Model::Unculled => words.push("every primitive tested for every ray".to_owned()),
            Model::Needed | Model::Unrebased => {}
        }
        if self.upscale > 1 {
            words.push(format!("1/{} size, scaled up", self.upscale));
        }
        words.join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::trace_light;
    use crate::scene::{Accelerator, check};
    use crate::trace::{RenderControl, Tracer};

    /// Rays of all kinds in a picture with one sample per pixel: with antialiasing, ragged edges would take more
    /// rays.
    fn rays(scene: &Scene, candidate: &Candidate) -> u64 {
        let request = RenderRequest {
            sampling: Sampling::Centres,
            ..candidate.request(scene)
        };
        let tracer = Tracer::new(&candidate.scene(scene), &request);
        let traced = trace_light(&tracer, &RenderControl::default());
        traced.expect("not stopped").1.total()
    }

    #[test]
    fn where_only_a_formula_differs_the_rays_are_as_many() {
        let scene = Scene::demo();
        let all = candidates(&scene, 96, 96);
        let named = |name: &str| all.iter().find(|candidate| candidate.name == name);
        let rays = |name: &str| rays(&scene, named(name).expect("a way")) as f64;
        let pairs = [
            ("sphere classic", UNCULLED),
            ("edges", "the plan"),
            ("moller-trumbore", "the plan"),
            ("edge-planes", "the plan"),
            ("highlight pow", "the plan"),
            ("highlight log1p", "the plan"),
            (UNCULLED, "the plan"),
        ];
        for (one, other) in pairs {
            let ratio = rays(one) / rays(other);
            assert!((ratio - 1.0).abs() < 2e-3, "{one} against {other}: {ratio}");
        }
    }

    #[test]
    fn every_way_of_every_list_is_compared_once() {
        let scene = Scene::demo();
        let all = candidates(&scene, 64, 64);
        let methods = Precision::ALL.len()
            + SphereMethod::ALL.len()
            + TriangleMethod::ALL.len()
            + RayOffset::ALL.len()
            + HighlightMethod::ALL.len()
            + Accelerator::ALL.len()
            - 6;
        assert_eq!(
            all.len(),
            2 + methods + 1 + 2 + 1 + GRIDS.len() + ADAPTIVE.len() + 1 + 2
        );
        let mut names: Vec<&str> = all.iter().map(|c| c.name.as_str()).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), all.len(), "{names:?}");
        for candidate in &all {
            assert_eq!(
                check(&candidate.scene(&scene)),
                Ok(()),
                "{}",
                candidate.name
            );
        }
        let mut other = scene.clone();
        other.render.sphere = SphereMethod::Classic;
        assert_eq!(candidates(&other, 64, 64)[1].name, "this scene");
    }
}
