//! The rays of a tile in stages: what all of them meet first; then, knowing where that is, the
//! light that falls on it; then the rays that mirrors send on, as the next stage.

use super::beam::{Bounds, beam_around};
use super::cull::{Candidates, LightCandidates, Room};
use super::hit::{Paths, Start, nearest};
use super::packet::{Link, Mark, Packet, RayCone};
use super::samples::{Samples, Traced};
use super::shade::Shader;
use super::thin::{LARGEST_STRETCH, SLIPPING};
use super::{Ray, Rays};
use crate::plan::Plan;
use crate::simd::{MAX_LANES, Mask as _, Real, SimdFloat, Vec3};

/// One bounce: its packets, and what they can meet.
struct Stage<L: SimdFloat> {
    packets: Vec<Packet<L>>,
    /// One for each packet, in stages of mirrored rays.
    links: Vec<Link<L>>,
    /// One for each packet, with edges.
    marks: Vec<Mark<L>>,
    seen: Candidates,
    /// Those of them that may slip between samples.
    thin: Candidates,
    shadows: Vec<LightCandidates>,
    signatures: Vec<[u32; MAX_LANES]>,
}

/// What traces the samples of a tile.
pub struct Engine<'a, L: SimdFloat> {
    plan: &'a Plan<L::Real>,
    stages: Vec<Stage<L>>,
    room: Room,
    /// Rays traced so far.
    pub rays: Rays,
}

impl<'a, L: SimdFloat> Engine<'a, L> {
    /// An engine for a plan.
    pub fn new(plan: &'a Plan<L::Real>) -> Self {
        Self {
            plan,
            stages: Vec::new(),
            room: Room::default(),
            rays: Rays::default(),
        }
    }

    /// Traces the samples, which can meet what is in `seen`. With `edges`, it also tells the
    /// samples' surroundings.
    pub fn trace(
        &mut self,
        token: L::Token,
        samples: &Samples<L::Real>,
        seen: &Candidates,
        edges: bool,
        traced: &mut Traced<L::Real>,
    ) {
        // A function of its own: it is long, and called from several places.
        L::vectorize(
            token,
            #[inline(always)]
            || self.trace_in_step(token, samples, seen, edges, traced),
        );
    }

    #[inline(always)]
    fn trace_in_step(
        &mut self,
        token: L::Token,
        samples: &Samples<L::Real>,
        seen: &Candidates,
        edges: bool,
        traced: &mut Traced<L::Real>,
    ) {
        let (count, length) = (samples.count, samples.x.len());
        if seen.is_empty() {
            self.rays.camera += count as u64;
            let background = clamped((), self.plan.background);
            return traced.fill(count, length, edges, background);
        }
        traced.resize(count, length, edges);
        self.start(token, samples, seen, edges);
        let mut depth = 0;
        loop {
            self.grow(depth + 1);
            let (stages, deeper) = self.stages.split_at_mut(depth + 1);
            let (stage, next) = (&mut stages[depth], &mut deeper[0]);
            next.clear();
            let may_mirror = (depth as u32) < self.plan.reflection_limit;
            let painter = Shader {
                token,
                plan: self.plan,
                may_mirror,
            };
            if stage.find(token, self.plan, &mut self.room) {
                stage.paint(&painter, next, &mut self.rays);
            }
            if next.packets.is_empty() {
                break;
            }
            next.aim(token, self.plan, &mut self.room);
            depth += 1;
        }
        if edges {
            for stage in &mut self.stages[..=depth] {
                stage.sign();
            }
        }
        for depth in (1..=depth).rev() {
            let (stages, deeper) = self.stages.split_at_mut(depth);
            stages[depth - 1].take_back(token, &deeper[0]);
            stages[depth - 1].take_marks_back(&deeper[0]);
        }
        self.stages[0].hand_out(token, traced);
    }

    fn grow(&mut self, depth: usize) {
        while self.stages.len() <= depth {
            let shadows = LightCandidates {
                casters: Candidates::all_casting(self.plan),
                thin: Candidates::default(),
                is_umbra: false,
            };
            self.stages.push(Stage {
                packets: Vec::new(),
                links: Vec::new(),
                marks: Vec::new(),
                seen: Candidates::default(),
                thin: Candidates::default(),
                shadows: vec![shadows; self.plan.lights.len()],
                signatures: Vec::new(),
            });
        }
    }

    #[inline(always)]
    fn start(
        &mut self,
        token: L::Token,
        samples: &Samples<L::Real>,
        seen: &Candidates,
        edges: bool,
    ) {
        self.grow(0);
        let stage = &mut self.stages[0];
        stage.seen.clone_from(seen);
        stage.clear();
        self.rays.camera += samples.count as u64;
        let lane_number = L::from_fn(token, |lane| L::Real::from_f64(lane as f64));
        for first in (0..samples.x.len()).step_by(L::WIDTH) {
            let centres = (
                L::load(token, &samples.x[first..]),
                L::load(token, &samples.y[first..]),
            );
            let (origin, direction) = self.plan.view.rays(token, centres.0, centres.1);
            let wanted = L::Real::from_f64((samples.count - first) as f64);
            let active = lane_number.less(L::splat(token, wanted));
            let rays = Ray { origin, direction };
            stage
                .packets
                .push(Packet::new(token, self.plan, rays, active));
        }
        if edges {
            let (width, spread) = self.plan.view.footprint();
            let trail = RayCone {
                width: L::splat(token, width),
                spread: L::splat(token, spread),
            };
            stage
                .marks
                .resize(stage.packets.len(), Mark::new(token, trail));
        }
    }
}

impl<L: SimdFloat> Stage<L> {
    fn clear(&mut self) {
        self.packets.clear();
        self.links.clear();
        self.marks.clear();
    }

    /// What the rays of a packet start on.
    #[inline(always)]
    fn start_of(&self, place: usize) -> Start<L> {
        match self.links.get(place) {
            None => Start::Nowhere,
            Some(link) => link.start,
        }
    }

    /// Finds what the packets meet, and what can cast shadows there. Whether there is anything.
    #[inline(always)]
    fn find(&mut self, token: L::Token, plan: &Plan<L::Real>, room: &mut Room) -> bool {
        if self.seen.is_empty() {
            return false;
        }
        let infinity = L::splat(token, L::Real::INFINITY);
        let mut bounds = Bounds::new(token);
        for place in 0..self.packets.len() {
            let start = self.start_of(place);
            let packet = &mut self.packets[place];
            let rays = packet.rays;
            packet.near = nearest(token, plan, &self.seen, &Paths { rays, start });
            let hit = packet.near.t.less(infinity) & packet.active;
            bounds.add(hit, rays.at(packet.near.t));
        }
        self.find_thin(plan);
        let Some(ball) = bounds.ball() else {
            return !self.thin.is_empty();
        };
        if plan.screen.is_some() {
            // Room for what passes beside the rays to the lights, closer than a pixel.
            let footprint = self.widest(token) * L::Real::from_f64(LARGEST_STRETCH);
            for (shadows, light) in self.shadows.iter_mut().zip(&plan.lights) {
                shadows.keep_between::<L>(token, plan, light, &ball, footprint, room);
            }
        }
        true
    }

    /// Finds what rays from the camera can meet, or just miss, between samples; nothing without
    /// edges. For mirrored rays, [`Self::aim`] knows.
    fn find_thin(&mut self, plan: &Plan<L::Real>) {
        if self.marks.is_empty() {
            self.thin.clear();
        } else if self.links.is_empty() {
            let slipping = L::Real::from_f64(SLIPPING);
            self.thin.keep_narrow(&self.seen, plan, |center, radius| {
                plan.view.width_at(center, radius) * slipping
            });
        }
    }

    /// The widest pixel at what was hit; zero without edges.
    #[inline(always)]
    fn widest(&self, token: L::Token) -> L::Real {
        let mut widest = L::splat(token, L::Real::ZERO);
        let infinity = L::splat(token, L::Real::INFINITY);
        for (mark, packet) in self.marks.iter().zip(&self.packets) {
            let hit = packet.near.t.less(infinity) & packet.active;
            let width = mark.trail.width + mark.trail.spread * packet.near.t;
            widest = L::select(hit, widest.max(width), widest);
        }
        widest.greatest()
    }

    #[inline(always)]
    fn paint(&mut self, painter: &Shader<L>, next: &mut Self, rays: &mut Rays) {
        let token = painter.token;
        for place in 0..self.packets.len() {
            let start = self.start_of(place);
            let mark = self.marks.get_mut(place);
            let packet = &mut self.packets[place];
            let mirrored = painter.paint(packet, start, mark, &self.thin, &self.shadows, rays);
            let Some(mirrored) = mirrored else {
                continue;
            };
            let Paths {
                rays: onwards,
                start,
            } = mirrored.paths;
            rays.reflected += u64::from(mirrored.where_.bits().count_ones());
            next.packets
                .push(Packet::new(token, painter.plan, onwards, mirrored.where_));
            next.links.push(Link {
                parent: place,
                start,
                filter: mirrored.filter,
            });
            if let Some(trail) = mirrored.trail {
                next.marks.push(Mark::new(token, trail));
            }
        }
    }

    /// Finds what mirrored rays can meet.
    #[inline(always)]
    fn aim(&mut self, token: L::Token, plan: &Plan<L::Real>, room: &mut Room) {
        let beam = if plan.screen.is_some() {
            beam_around(token, &self.packets)
        } else {
            None
        };
        let Some(beam) = beam else {
            self.seen = Candidates::all(plan);
            self.thin.clone_from(&self.seen);
            return;
        };
        // Room for what passes beside the rays, closer than a pixel.
        let (mut width, mut spread) = (
            L::splat(token, L::Real::ZERO),
            L::splat(token, L::Real::ZERO),
        );
        for (mark, packet) in self.marks.iter().zip(&self.packets) {
            width = L::select(packet.active, width.max(mark.trail.width), width);
            spread = L::select(packet.active, spread.max(mark.trail.spread), spread);
        }
        let (width, spread) = (width.greatest(), spread.greatest());
        let beam = beam.widened(width, spread);
        self.seen
            .keep_met::<L>(token, plan, &beam, self.start_plane(plan), room);
        if !self.marks.is_empty() {
            let slipping = L::Real::from_f64(SLIPPING);
            self.thin.keep_narrow(&self.seen, plan, |center, radius| {
                (width + spread * beam.distance(center, radius)) * slipping
            });
        }
    }

    /// The plane that all rays start on, if they all start on one.
    fn start_plane(&self, plan: &Plan<L::Real>) -> Option<usize> {
        let Start::On(first) = self.links.first()?.start else {
            return None;
        };
        let is_shared = self
            .links
            .iter()
            .all(|link| matches!(link.start, Start::On(start) if start == first));
        let plane = first.checked_sub(plan.spheres.len())?;
        (is_shared && plane < plan.planes.len()).then_some(plane)
    }

    /// Adds what the mirrored rays brought back.
    #[inline(always)]
    fn take_back(&mut self, token: L::Token, mirrored: &Self) {
        for (packet, link) in mirrored.packets.iter().zip(&mirrored.links) {
            let parent = &mut self.packets[link.parent];
            let added = link.filter.filter(clamped(token, packet.color));
            parent.color = Vec3::select(packet.active, parent.color + added, parent.color);
        }
    }

    /// Adds what the mirrored rays know of their surroundings.
    #[inline(always)]
    fn take_marks_back(&mut self, mirrored: &Self) {
        for (place, mark) in mirrored.marks.iter().enumerate() {
            let active = mirrored.packets[place].active;
            let parent = mirrored.links[place].parent;
            let own = &mut self.marks[parent];
            own.near = L::select(active, mark.near.min(own.near), own.near);
            let active = active.bits();
            let theirs = &mirrored.signatures[place];
            for (lane, own) in self.signatures[parent].iter_mut().enumerate() {
                if active >> lane & 1 == 1 {
                    *own = own.rotate_left(11) ^ theirs[lane];
                }
            }
        }
    }

    /// Notes what each ray of the stage has hit, and which lights shine on it.
    #[inline(always)]
    fn sign(&mut self) {
        self.signatures.clear();
        for (packet, mark) in self.packets.iter().zip(&self.marks) {
            let mut numbers = [L::Real::ZERO; MAX_LANES];
            let mut lit = numbers;
            packet.near.number.store(&mut numbers);
            mark.lit.store(&mut lit);
            let mut signature = [0; MAX_LANES];
            for lane in 0..L::WIDTH {
                // Odd multipliers spread the small numbers over all bits.
                let number = (numbers[lane] + L::Real::ONE).nearest();
                let lit = lit[lane].nearest();
                signature[lane] = number.wrapping_mul(0x9E37_79B1) ^ lit.wrapping_mul(0x85EB_CA6B);
            }
            self.signatures.push(signature);
        }
    }

    #[inline(always)]
    fn hand_out(&self, token: L::Token, traced: &mut Traced<L::Real>) {
        for (place, packet) in self.packets.iter().enumerate() {
            let first = place * L::WIDTH;
            let color = clamped(token, packet.color);
            color.x.store(&mut traced.red[first..]);
            color.y.store(&mut traced.green[first..]);
            color.z.store(&mut traced.blue[first..]);
        }
        for (place, mark) in self.marks.iter().enumerate() {
            let first = place * L::WIDTH;
            mark.near.store(&mut traced.near[first..]);
            traced.signature[first..first + L::WIDTH]
                .copy_from_slice(&self.signatures[place][..L::WIDTH]);
        }
    }
}

#[inline(always)]
fn clamped<L: SimdFloat>(token: L::Token, color: Vec3<L>) -> Vec3<L> {
    color.clamp(
        L::splat(token, L::Real::ZERO),
        L::splat(token, L::Real::ONE),
    )
}
