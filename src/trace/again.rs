//! Samples that are traced again, in double precision.

use std::sync::atomic::AtomicBool;

use super::candidates::Candidates;
use super::engine::{Engine, Reference, Workspace};
use super::intersect::Kernel;
use super::samples::{Edges, Samples, Traced};
use super::shelf::Shelf;
use crate::plan::Plan;
use crate::simd::{Level, SimdFloat, WithSimd};

/// The same picture in double precision.
#[derive(Debug)]
pub struct Exact {
    plan: Box<Plan<f64>>,
    /// Everything that can be seen.
    seen: Candidates,
    level: Level,
    shelf: Shelf,
}

impl Exact {
    /// What traces samples of a plan.
    pub fn new(plan: Box<Plan<f64>>, level: Level) -> Self {
        Self {
            seen: Candidates::all_seen(&plan),
            plan,
            level,
            shelf: Shelf::default(),
        }
    }
}

impl Reference for Exact {
    fn trace(
        &self,
        samples: &mut Samples<f64>,
        edges: Edges,
        stop: &AtomicBool,
        traced: &mut Traced<f64>,
    ) {
        self.level.run(Again {
            exact: self,
            samples,
            edges,
            stop,
            traced,
        });
    }
}

/// Samples to be traced.
struct Again<'a> {
    exact: &'a Exact,
    samples: &'a mut Samples<f64>,
    edges: Edges,
    stop: &'a AtomicBool,
    traced: &'a mut Traced<f64>,
}

impl WithSimd<f64> for Again<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: SimdFloat<Real = f64>>(self, token: L::Token) {
        let Exact {
            plan, seen, shelf, ..
        } = self.exact;
        let mut work = shelf.take::<Workspace<L>>().unwrap_or_default();
        self.samples.pad(L::WIDTH);
        let kernel = Kernel { token, plan };
        let mut engine = Engine::<L, true>::new(kernel, &mut work, (self.stop, None));
        engine.trace(self.samples, seen, self.edges, self.traced);
        shelf.put(work);
    }
}
