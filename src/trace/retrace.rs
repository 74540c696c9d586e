//! Retracing of samples in double precision.

use super::candidates::Candidates;
use super::control::RenderControl;
use super::engine::{Engine, Retracer, Workspace};
use super::intersect::Kernel;
use super::samples::{EdgeDetail, Samples, Traced};
use super::workspace_pool::WorkspacePool;
use crate::plan::Plan;
use crate::simd::{Level, SimdFloat, WithSimd};

/// The plan of the same picture in double precision.
#[derive(Debug)]
pub struct DoublePrecision {
    plan: Box<Plan<f64>>,
    /// Everything that camera rays may hit first.
    candidates: Candidates,
    level: Level,
    workspace_pool: WorkspacePool,
}

impl DoublePrecision {
    /// Creates a retracer from a plan.
    pub fn new(plan: Box<Plan<f64>>, level: Level) -> Self {
        Self {
            candidates: Candidates::all_seen(&plan),
            plan,
            level,
            workspace_pool: WorkspacePool::default(),
        }
    }
}

impl Retracer for DoublePrecision {
    fn trace(
        &self,
        samples: &mut Samples<f64>,
        edges: EdgeDetail,
        control: &RenderControl,
        traced: &mut Traced<f64>,
    ) {
        self.level.run(Retrace {
            retracer: self,
            samples,
            edges,
            control,
            traced,
        });
    }
}

/// Samples to trace.
struct Retrace<'a> {
    retracer: &'a DoublePrecision,
    samples: &'a mut Samples<f64>,
    edges: EdgeDetail,
    control: &'a RenderControl,
    traced: &'a mut Traced<f64>,
}

impl WithSimd<f64> for Retrace<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: SimdFloat<Real = f64>>(self, token: L::Token) {
        let DoublePrecision {
            plan,
            candidates,
            workspace_pool,
            ..
        } = self.retracer;
        let mut work = workspace_pool.take::<Workspace<L>>().unwrap_or_default();
        self.samples.pad(L::WIDTH);
        let kernel = Kernel { token, plan };
        let mut engine = Engine::<L, true>::new(kernel, &mut work, self.control, None);
        engine.trace(self.samples, candidates, self.edges, self.traced);
        workspace_pool.put(work);
    }
}
