//! The rays of a tile, bounce by bounce: what all of them meet first; then, knowing where that is, the
//! light that falls on it; then the rays that mirrors send on, as the next bounce.

use std::sync::atomic::{AtomicBool, Ordering};

use super::bounce::Bounce;
use super::candidates::Candidates;
use super::cull::Scratch;
use super::intersect::Kernel;
use super::outcome::clamped;
use super::samples::{Edges, Samples, Traced};
use super::stats::Rays;
use crate::plan::Show;
use crate::simd::{SimdFloat, Vec3};

/// What an engine works with, and the next one for the same plan may as well.
pub struct Workspace<L: SimdFloat> {
    bounces: Vec<Bounce<L>>,
    scratch: Scratch<L::Real>,
    /// What was seen by rays that were put in another order than the samples.
    unsorted: Traced<L::Real>,
}

impl<L: SimdFloat> Default for Workspace<L> {
    fn default() -> Self {
        Self {
            bounces: Vec::new(),
            scratch: Scratch::default(),
            unsorted: Traced::default(),
        }
    }
}

/// What traces the samples of a tile.
pub struct Engine<'a, L: SimdFloat, const TREE: bool> {
    kernel: Kernel<'a, L, TREE>,
    work: &'a mut Workspace<L>,
    /// Whether nobody wants the picture any more: the rays of one tile can take minutes.
    stop: &'a AtomicBool,
    /// Rays traced so far.
    pub rays: Rays,
}

impl<'a, L: SimdFloat, const TREE: bool> Engine<'a, L, TREE> {
    /// An engine for a plan, which does nothing more once `stop` is set.
    pub fn new(
        kernel: Kernel<'a, L, TREE>,
        work: &'a mut Workspace<L>,
        stop: &'a AtomicBool,
    ) -> Self {
        Self {
            kernel,
            work,
            stop,
            rays: Rays::default(),
        }
    }

    /// The proof that the processor has the lanes.
    pub fn token(&self) -> L::Token {
        self.kernel.token
    }

    /// Whether what is traced is for nothing.
    pub fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Traces the samples, which can meet what is in `seen`; once the engine is stopped, what is seen is arbitrary.
    pub fn trace(
        &mut self,
        samples: &Samples<L::Real>,
        seen: &Candidates,
        edges: Edges,
        traced: &mut Traced<L::Real>,
    ) {
        // A function of its own: it is long, and called from several places.
        L::vectorize(
            self.kernel.token,
            #[inline(always)]
            || self.trace_vectorized(samples, seen, edges, traced),
        );
    }

    #[inline(always)]
    fn trace_vectorized(
        &mut self,
        samples: &Samples<L::Real>,
        seen: &Candidates,
        edges: Edges,
        traced: &mut Traced<L::Real>,
    ) {
        let kernel = self.kernel;
        let (count, length) = (samples.count, samples.x.len());
        if self.is_stopped() {
            return traced.fill(count, length, edges, Vec3::default());
        }
        self.rays.camera += count as u64;
        if seen.is_empty() {
            let sky = match kernel.plan.show {
                Show::Mirrors => Vec3::default(),
                _ => clamped(kernel.plan.background),
            };
            return traced.fill(count, length, edges, sky);
        }
        let with_edges = edges != Edges::Ignored;
        traced.resize(count, length, edges);
        self.grow(0);
        self.work.bounces[0].start(kernel, samples, seen, edges);

        // Forth: each bounce sends the next one on its way.
        let mut depth = 0;
        loop {
            self.grow(depth + 1);
            let (bounces, deeper) = self.work.bounces.split_at_mut(depth + 1);
            let (bounce, next) = (&mut bounces[depth], &mut deeper[0]);
            next.clear();
            next.edges_are = bounce.edges_are;
            let may_mirror = (depth as u32) < kernel.plan.reflection_limit;
            if bounce.find(kernel, &mut self.work.scratch) {
                if depth == 0 {
                    bounce.arrange(kernel, samples);
                }
                let counted = (&mut self.work.scratch.stack, &mut self.rays);
                bounce.shade(kernel, may_mirror, next, counted);
            }
            if next.is_empty() || self.stop.load(Ordering::Relaxed) {
                break;
            }
            next.aim(kernel, &mut self.work.scratch);
            depth += 1;
        }
        if with_edges {
            for bounce in &mut self.work.bounces[..=depth] {
                bounce.sign(kernel.plan);
            }
        }

        // And back: each bounce takes what the next one has seen.
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
