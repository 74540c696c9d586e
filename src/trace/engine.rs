//! Traces the rays of a tile bounce by bounce: first what all of them hit; then, knowing where that is, the light
//! that falls on it; then the rays that mirrors send on, as the next bounce.

use super::bounce::Bounce;
use super::candidates::Candidates;
use super::control::RenderControl;
use super::cull::Scratch;
use super::faces::note_faces;
use super::intersect::Kernel;
use super::outcome::clamped;
use super::samples::{EdgeDetail, Samples, Traced};
use super::stats::Rays;
use crate::plan::Show;
use crate::simd::{Real, SimdFloat, Vec3};

/// Scratch memory of an engine, reusable by the next engine for the same plan.
pub struct Workspace<L: SimdFloat> {
    bounces: Vec<Bounce<L>>,
    scratch: Scratch<L::Real>,
    /// Results of rays that were traced in another order than the samples.
    unsorted: Traced<L::Real>,
    retraced: RetracedSamples,
}

/// Samples that are retraced.
#[derive(Default)]
struct RetracedSamples {
    /// Their indices.
    indices: Vec<u32>,
    samples: Samples<f64>,
    traced: Traced<f64>,
}

/// Retraces samples for which rounding may have decided what was seen.
pub trait Retracer: Sync {
    /// Traces the samples in double precision.
    fn trace(
        &self,
        samples: &mut Samples<f64>,
        edges: EdgeDetail,
        control: &RenderControl,
        traced: &mut Traced<f64>,
    );
}

impl<L: SimdFloat> Default for Workspace<L> {
    fn default() -> Self {
        Self {
            bounces: Vec::new(),
            scratch: Scratch::default(),
            unsorted: Traced::default(),
            retraced: RetracedSamples::default(),
        }
    }
}

/// Traces the samples of a tile.
pub struct Engine<'a, L: SimdFloat, const TREE: bool> {
    kernel: Kernel<'a, L, TREE>,
    work: &'a mut Workspace<L>,
    /// Tells whether the picture is still wanted; asked also within a tile, whose rays can take minutes.
    control: &'a RenderControl,
    retracer: Option<&'a dyn Retracer>,
    /// Number of rays traced so far.
    pub rays: Rays,
}

impl<'a, L: SimdFloat, const TREE: bool> Engine<'a, L, TREE> {
    /// Creates an engine for a plan. It does nothing more once `control` is stopped; `retracer`, if given, retraces
    /// doubtful samples.
    pub fn new(
        kernel: Kernel<'a, L, TREE>,
        work: &'a mut Workspace<L>,
        control: &'a RenderControl,
        retracer: Option<&'a dyn Retracer>,
    ) -> Self {
        Self {
            kernel,
            work,
            control,
            retracer,
            rays: Rays::default(),
        }
    }

    /// The proof that the processor has these lanes.
    pub fn token(&self) -> L::Token {
        self.kernel.token
    }

    /// Returns whether the trace was stopped.
    pub fn is_stopped(&self) -> bool {
        self.control.is_stopped()
    }

    /// Traces the samples, whose rays can meet what is in `candidates`. Once the engine is stopped, the results are
    /// arbitrary.
    pub fn trace(
        &mut self,
        samples: &Samples<L::Real>,
        candidates: &Candidates,
        edges: EdgeDetail,
        traced: &mut Traced<L::Real>,
    ) {
        // A function of its own, since it is long and called from several places.
        L::vectorize(
            self.kernel.token,
            #[inline(always)]
            || self.trace_vectorized(samples, candidates, edges, traced),
        );
        let is_anything_seen = !candidates.is_empty() && !self.is_stopped();
        // There are no faces in most scenes, and few in others: noted outside of the kernel, which is faster
        // without.
        traced.faces.clear();
        if edges >= EdgeDetail::Borders && is_anything_seen {
            let bounce = &self.work.bounces[0];
            let packets = (&bounce.packets[..], &bounce.order.samples[..]);
            note_faces(self.kernel.plan, packets, traced);
        }
        if let Some(retracer) = self.retracer.filter(|_| is_anything_seen) {
            self.retrace(retracer, samples, edges, traced);
        }
        if self.kernel.plan.show == Show::Retraced {
            let indices = &self.work.retraced.indices;
            traced.mark(if is_anything_seen { indices } else { &[] });
        }
    }

    /// Retraces the samples that are in doubt.
    fn retrace(
        &mut self,
        retracer: &dyn Retracer,
        samples: &Samples<L::Real>,
        edges: EdgeDetail,
        traced: &mut Traced<L::Real>,
    ) {
        let Workspace {
            bounces, retraced, ..
        } = &mut *self.work;
        bounces[0].list_doubtful(samples.count, &mut retraced.indices);
        if retraced.indices.is_empty() {
            return;
        }
        retraced.samples.clear();
        for &index in &retraced.indices {
            let (x, y) = (samples.x[index as usize], samples.y[index as usize]);
            retraced.samples.push(x.to_f64(), y.to_f64());
        }
        retracer.trace(
            &mut retraced.samples,
            edges,
            self.control,
            &mut retraced.traced,
        );
        traced.replace(&retraced.indices, &retraced.traced);
        self.rays.again += retraced.indices.len() as u64;
    }

    #[inline(always)]
    fn trace_vectorized(
        &mut self,
        samples: &Samples<L::Real>,
        candidates: &Candidates,
        edges: EdgeDetail,
        traced: &mut Traced<L::Real>,
    ) {
        let kernel = self.kernel;
        let (count, length) = (samples.count, samples.x.len());
        if self.is_stopped() {
            return traced.fill(count, length, edges, Vec3::default());
        }
        self.rays.camera += count as u64;
        if candidates.is_empty() {
            let sky = match kernel.plan.show {
                Show::Mirrors => Vec3::default(),
                _ => clamped(kernel.plan.background),
            };
            return traced.fill(count, length, edges, sky);
        }
        let with_edges = edges != EdgeDetail::Ignored;
        traced.resize(count, length, edges);
        self.grow(0);
        self.work.bounces[0].start(kernel, samples, candidates, edges);

        // Forward: each bounce spawns the rays of the next one.
        let mut depth = 0;
        loop {
            self.grow(depth + 1);
            let (bounces, deeper) = self.work.bounces.split_at_mut(depth + 1);
            let (bounce, next) = (&mut bounces[depth], &mut deeper[0]);
            next.clear();
            next.edge_detail = bounce.edge_detail;
            let may_mirror = (depth as u32) < kernel.plan.reflection_limit;
            if bounce.find_hits(kernel, &mut self.work.scratch) {
                if depth == 0 {
                    bounce.regroup_hits(kernel, samples);
                }
                let counted = (&mut self.work.scratch.stack, &mut self.rays);
                bounce.shade(kernel, may_mirror, next, counted);
            }
            if next.is_empty() || self.control.is_stopped() {
                break;
            }
            next.find_candidates(kernel, &mut self.work.scratch);
            depth += 1;
        }
        if with_edges {
            for bounce in &mut self.work.bounces[..=depth] {
                bounce.compute_signatures(kernel.plan);
            }
        }

        // Backward: each bounce takes the results of the next one.
        for depth in (1..=depth).rev() {
            let (bounces, deeper) = self.work.bounces.split_at_mut(depth);
            bounces[depth - 1].take_colors(&deeper[0]);
            bounces[depth - 1].take_edges(&deeper[0]);
        }
        self.work.bounces[0].store(edges, traced, &mut self.work.unsorted);
    }

    fn grow(&mut self, depth: usize) {
        while self.work.bounces.len() <= depth {
            self.work.bounces.push(Bounce::new(self.kernel.plan));
        }
    }
}
