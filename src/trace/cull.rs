//! Leaving primitives out before a ray is touched: those beside a tile, those that its mirrors
//! cannot show, and those that cannot cast a shadow into it.

use std::ops::Range;

use super::beam::{Beam, is_hidden};
use super::sampling::Tile;
use super::thin::SLIPPING;
use crate::plan::{Ball, Extent, Plan, PointLight, ScreenExtents};
use crate::simd::{Real, SimdFloat, Vec3};

/// The primitives that are worth testing, by their places in the plan's lists.
#[derive(Clone, Debug, Default)]
pub struct Candidates {
    /// Places in [`Plan::spheres`].
    pub spheres: Vec<u32>,
    /// Places in [`Plan::planes`].
    pub planes: Vec<u32>,
    /// Places in [`Plan::triangles`].
    pub triangles: Vec<u32>,
}

/// Room to gather lists in, used again for every beam.
#[derive(Debug, Default)]
pub struct Room {
    stack: Vec<(usize, usize)>,
    met: Vec<u32>,
}

impl Candidates {
    /// Everything there is, markers included.
    pub fn all<R: Real>(plan: &Plan<R>) -> Self {
        Self {
            spheres: count(plan.spheres.len()),
            planes: count(plan.planes.len()),
            triangles: count(plan.triangles.len()),
        }
    }

    /// Everything that camera rays may meet first.
    pub fn all_seen<R: Real>(plan: &Plan<R>) -> Self {
        let mut all = Self::all(plan);
        all.triangles
            .retain(|&index| !is_set(&plan.camera_culled_faces, index));
        all
    }

    /// Everything that casts shadows.
    pub fn all_casting<R: Real>(plan: &Plan<R>) -> Self {
        let mut all = Self::all(plan);
        all.spheres.truncate(plan.casting_spheres);
        if !plan.planes_cast {
            all.planes.clear();
        }
        all
    }

    /// Forgets all.
    pub fn clear(&mut self) {
        self.spheres.clear();
        self.planes.clear();
        self.triangles.clear();
    }

    /// Whether there is nothing to test.
    pub fn is_empty(&self) -> bool {
        self.spheres.is_empty() && self.planes.is_empty() && self.triangles.is_empty()
    }

    /// Becomes those of `from` that a tile of these columns (or rows) can show.
    pub fn keep_seen(
        &mut self,
        from: &Self,
        screen: Option<&ScreenExtents>,
        pixels: &Range<usize>,
        axis: Axis,
    ) {
        let Some(screen) = screen else {
            return self.clone_from(from);
        };
        let meets = |extents: &(Extent, Extent)| match axis {
            Axis::Columns => extents.0.meets(pixels.start, pixels.end),
            Axis::Rows => extents.1.meets(pixels.start, pixels.end),
        };
        keep(&mut self.spheres, &from.spheres, |index| {
            meets(&screen.spheres[index])
        });
        keep(&mut self.triangles, &from.triangles, |index| {
            meets(&screen.triangles[index])
        });
        self.planes.clone_from(&from.planes);
    }

    /// Becomes those of `from` that are narrower than the width at their farthest point.
    pub fn keep_narrow<R: Real>(
        &mut self,
        from: &Self,
        plan: &Plan<R>,
        width: impl Fn(Vec3<R>, R) -> R,
    ) {
        self.planes.clear();
        keep(&mut self.spheres, &from.spheres, |index| {
            let sphere = &plan.spheres[index];
            sphere.radius + sphere.radius < width(sphere.center, sphere.radius)
        });
        keep(&mut self.triangles, &from.triangles, |index| {
            let triangle = &plan.triangles[index];
            let [a, b, c] = triangle.corners;
            let reach = (b - a).length().max((c - a).length());
            triangle.thickness < width(a, reach)
        });
    }

    /// Leaves out the planes that the rays of a tile pass by or leave behind.
    ///
    /// Height over the plane and speed towards it change along a row or column by equal steps, so
    /// that their signs at the corners are all that there are.
    pub fn drop_unseen_planes<R: Real>(&mut self, plan: &Plan<R>, tile: &Tile) {
        let edge = |index: usize| R::from_f64(index as f64);
        let (left, right) = (edge(tile.columns.start), edge(tile.columns.end));
        let (top, bottom) = (edge(tile.rows.start), edge(tile.rows.end));
        let corners = [(left, top), (right, top), (left, bottom), (right, bottom)];
        let corners = corners.map(|(x, y)| plan.view.rays((), x, y));
        let little = R::from_f64(1e-5);
        self.planes.retain(|&index| {
            let plane = &plan.planes[index as usize];
            corners.iter().any(|(origin, direction)| {
                let height = plane.offset - plane.normal.dot(*origin);
                let speed = plane.normal.dot(*direction);
                let is_near = height.abs() <= little * (origin.max_abs() + plane.offset.abs());
                is_near || speed.abs() <= little || (height > R::ZERO) == (speed > R::ZERO)
            })
        });
    }

    /// Becomes what rays of the beam can meet, markers included, but for a plane that all of them
    /// start on.
    #[inline(always)]
    pub fn keep_met<L: SimdFloat>(
        &mut self,
        token: L::Token,
        plan: &Plan<L::Real>,
        beam: &Beam<L::Real>,
        start_plane: Option<usize>,
        room: &mut Room,
    ) {
        beam.gather::<L>(token, &plan.volumes, &mut room.stack, &mut room.met);
        self.sort_out(plan, &room.met, plan.spheres.len(), &[]);
        self.planes.clear();
        for (index, plane) in plan.planes.iter().enumerate() {
            if start_plane != Some(index) && beam.crosses(plane.normal, plane.offset) {
                self.planes.push(index as u32);
            }
        }
    }

    /// Takes bounded primitives apart by kind, leaving out spheres from `spheres` on and triangles
    /// that are `idle`.
    fn sort_out<R: Real>(
        &mut self,
        plan: &Plan<R>,
        bounded: &[u32],
        spheres: usize,
        idle: &[bool],
    ) {
        self.spheres.clear();
        self.triangles.clear();
        for &member in bounded {
            let index = member as usize;
            if index < spheres {
                self.spheres.push(member);
            } else if index >= plan.spheres.len() {
                let triangle = (index - plan.spheres.len()) as u32;
                if !is_set(idle, triangle) {
                    self.triangles.push(triangle);
                }
            }
        }
    }
}

/// What can stand between a light and the hits of a tile.
#[derive(Clone, Debug, Default)]
pub struct LightCandidates {
    /// What may block the light for some of them.
    pub casters: Candidates,
    /// Those of them whose shadows may slip between samples.
    pub thin: Candidates,
    /// Whether one sphere blocks it for all of them.
    pub is_umbra: bool,
}

impl LightCandidates {
    /// Becomes what can stand between a light and some point of a ball, `footprint` around it
    /// included.
    #[inline(always)]
    pub fn keep_between<L: SimdFloat>(
        &mut self,
        token: L::Token,
        plan: &Plan<L::Real>,
        light: &PointLight<L::Real>,
        ball: &Ball,
        footprint: L::Real,
        room: &mut Room,
    ) {
        let from = light.position.to_dvec3();
        let slipping = footprint * L::Real::from_f64(SLIPPING);
        let Some(beam) = Beam::to_ball(from, ball) else {
            self.casters = Candidates::all_casting(plan);
            self.thin.keep_narrow(&self.casters, plan, |_, _| slipping);
            self.is_umbra = false;
            return;
        };
        let beam = beam.widened(footprint, L::Real::ZERO);
        beam.gather::<L>(token, &plan.volumes, &mut room.stack, &mut room.met);
        self.casters.sort_out(
            plan,
            &room.met,
            plan.casting_spheres,
            &light.shadow_culled_faces,
        );
        self.casters.planes.clear();
        if plan.planes_cast {
            self.casters.planes.extend(0..plan.planes.len() as u32);
        }
        self.thin.keep_narrow(&self.casters, plan, |_, _| slipping);
        self.is_umbra = self.casters.spheres.iter().any(|&index| {
            let sphere = &plan.spheres[index as usize];
            let sphere = Ball {
                center: sphere.center.to_dvec3(),
                radius: sphere.radius.to_f64(),
            };
            is_hidden(from, &sphere, ball)
        });
    }
}

/// Direction of a range of pixels.
#[derive(Clone, Copy, Debug)]
pub enum Axis {
    /// From left to right.
    Columns,
    /// From top to bottom.
    Rows,
}

fn is_set(flags: &[bool], index: u32) -> bool {
    flags.get(index as usize) == Some(&true)
}

fn count(length: usize) -> Vec<u32> {
    (0..length as u32).collect()
}

fn keep(list: &mut Vec<u32>, from: &[u32], is_wanted: impl Fn(usize) -> bool) {
    list.clear();
    list.extend(
        from.iter()
            .copied()
            .filter(|&index| is_wanted(index as usize)),
    );
}
