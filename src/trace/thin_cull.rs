//! Whether something thin in the trees may slip between the samples of a tile at all: most tiles are spared the
//! search ray by ray.

use super::bundle::Shaft;
use super::thin_margin::ThinMargin;
use super::thresholds::{CROWDED_FACES_PER_PIXEL, MERGED_SIZE, SMALL_MESH_PIXELS};
use crate::plan::{Bvh, Child, GROUP, Geometry, PackedMesh};
use crate::primitive::BoundingBox;
use crate::simd::{Real, SimdFloat};

/// Number of nodes that are examined; if that is not enough, something thin may be there.
const MAX_NODES: u32 = 32;

/// Returns the size in pixels below which a mesh may slip between samples as a whole: with that many faces per
/// pixel, testing each is too slow.
#[inline(always)]
pub fn small_mesh_pixels<R: Real>(mesh: &PackedMesh<R>) -> R {
    let faces = R::from_f64(mesh.triangles.len() as f64 / CROWDED_FACES_PER_PIXEL);
    faces.sqrt().max(R::from_f64(SMALL_MESH_PIXELS))
}

/// Returns whether any ray of the shaft may pass close to something thin in the trees, at any distance.
#[inline(never)]
pub fn may_pass_thin<L: SimdFloat>(
    token: L::Token,
    geometry: &Geometry<L::Real>,
    shaft: &Shaft<L::Real>,
    margin: &ThinMargin<L::Real>,
) -> bool {
    L::vectorize(
        token,
        #[inline(always)]
        || {
            let mut nodes_left = MAX_NODES;
            let query = (shaft, margin, &mut nodes_left);
            is_close::<L>(
                token,
                &geometry.bvh,
                query,
                #[inline(always)]
                |member, width, nodes_left| {
                    let first = geometry.primitives.len();
                    let Some(mesh) = (member as usize).checked_sub(first) else {
                        return true;
                    };
                    let instance = &geometry.meshes[mesh];
                    let (_, radius) = instance.mesh.bvh.bounds.ball();
                    if radius + radius < width * small_mesh_pixels(&instance.mesh) {
                        return true;
                    }
                    let query = (&shaft.seen_from(instance.centre), margin, nodes_left);
                    is_close::<L>(
                        token,
                        &instance.mesh.bvh,
                        query,
                        #[inline(always)]
                        |_, _, _| true,
                    )
                },
            )
        },
    )
}

/// Returns whether any ray may pass close to a thin member of a tree for which `accepts` holds. That gets the largest
/// width of a pixel there, and the number of nodes that are left to examine.
#[inline(always)]
fn is_close<L: SimdFloat>(
    token: L::Token,
    bvh: &Bvh<L::Real>,
    (shaft, margin, nodes_left): (&Shaft<L::Real>, &ThinMargin<L::Real>, &mut u32),
    accepts: impl Fn(u32, L::Real, &mut u32) -> bool,
) -> bool {
    let mut stack = [0; MAX_NODES as usize];
    let mut count = 1;
    while 0 < count {
        count -= 1;
        let Some(node) = bvh.nodes.get(stack[count] as usize) else {
            return false;
        };
        if *nodes_left == 0 {
            return true;
        }
        *nodes_left -= 1;
        let mut widths = [L::Real::ZERO; GROUP];
        let mut bits = shaft.meets_thin::<L>(token, node, L::Real::INFINITY, margin, &mut widths);
        while bits != 0 {
            let index = bits.trailing_zeros() as usize;
            bits &= bits - 1;
            match node.child(index) {
                Child::Member(member) if accepts(member, widths[index], nodes_left) => return true,
                Child::Member(_) => {}
                Child::Node(_) if count == stack.len() => return true,
                // Its contents are treated as one thing, and not told apart.
                Child::Node(_) if is_merged(node.bounds(index), widths[index]) => return true,
                Child::Node(inner) => {
                    stack[count] = inner;
                    count += 1;
                }
            }
        }
    }
    false
}

/// Returns whether the contents of a box may be treated as one thing where pixels are this wide.
#[inline(always)]
fn is_merged<R: Real>(bounds: BoundingBox<R>, width: R) -> bool {
    let (_, radius) = bounds.ball();
    radius + radius < width * R::from_f64(MERGED_SIZE)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::mesh::SOLIDS;
    use crate::plan::{Plan, PlanCache, RenderRequest};
    use crate::scene::{Mesh, Object, Scene, Shape};
    use crate::simd::Vec3;

    #[test]
    fn something_thin_is_looked_for_where_rays_come_close_to_it() {
        let solid = |name: &str, x: f64, thickness: f64| {
            let solid = SOLIDS.iter().find(|solid| solid.name == name);
            let mesh = Mesh {
                position: DVec3::new(x, 0.0, 0.0),
                scale: DVec3::new(thickness, 1.0, thickness),
                ..Mesh::of((solid.expect("there is").make)(20.0))
            };
            Object {
                name: format!("{name} at {x}"),
                shape: Shape::Mesh(mesh),
                ..Scene::demo().objects[0].clone()
            }
        };
        let mut scene = Scene::demo();
        scene.objects = [
            solid("Icosphere", 0.0, 1.0),
            solid("Cylinder", 100.0, 0.01),
            solid("Icosphere", 200.0, 1.0),
        ]
        .into_iter()
        .collect();
        let request = RenderRequest::sized(1, 1);
        let plan: Plan<f64> = Plan::new(&scene, &request, &mut PlanCache::default());
        let geometry = plan.geometry.as_deref().expect("meshes");
        let is_close = |x: f64, width: f64| {
            // Has a part along each axis, so that the rays have something in common along all of them.
            let direction = DVec3::new(0.3, 0.3, -1.0);
            let start = DVec3::new(x, 0.0, 0.0) - direction * 300.0 - plan.centre;
            let origins = BoundingBox::around(&[Vec3::from_dvec3(start)]).widened(4.0);
            let directions = BoundingBox::around(&[Vec3::from_dvec3(direction)]).widened(0.01);
            let margin = ThinMargin::new(width, 0.0);
            may_pass_thin::<f64>((), geometry, &Shaft::of(&origins, &directions), &margin)
        };
        // The cylinder is 0.2 thick: a little less than two of the wider pixels, and more than two of the others.
        for (x, is_thin) in [(0.0, false), (100.0, true), (200.0, false)] {
            assert_eq!(is_close(x, 0.11), is_thin, "at {x}");
            assert!(!is_close(x, 0.05), "at {x}");
            // As a whole, each is smaller than a few pixels.
            assert!(is_close(x, 11.0), "at {x}");
        }
    }
}
