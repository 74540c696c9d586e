//! The data that the kernels need, recomputed from the scene on every edit: primitives packed by kind, relative to
//! the scene's middle and in the kernel's real type, without what the picture cannot show. Contains no names and no
//! file paths.

mod balls;

mod grouping;

mod slices;

mod bvh;

mod cast;

mod components;

mod borders;

mod tips;

mod thickness;

mod smooth;

mod oriented_box;

mod packed_mesh;

mod meshes;

mod culled_faces;

mod request;

mod contacts;

mod solids;

mod geometry;

mod flats;

mod closeness;

mod precision;

mod materials;

mod plane_occluders;

mod lights;

mod ray_origin;

mod view;

mod show;

mod hit_order;

mod pack;

mod doubt;

mod ties;

mod holding;

mod faces;

mod tests_spared;

mod needs;

pub use balls::Balls;
pub use bvh::{Bvh, Child, GROUP, Node};
pub use contacts::RankedObjects;
pub use culled_faces::CulledFaces;
pub use flats::FlatExtent;
pub use geometry::{Geometry, PlanCache, Planner};
pub use hit_order::HitOrder;
pub use lights::PointLight;
pub use materials::{Material, Surface, exponent};
pub use needs::{ACCELERATOR, Need, needs};
pub use oriented_box::OrientedBox;
pub use pack::Plan;
pub use packed_mesh::{MeshInstance, PackedMesh};
pub use precision::{is_double, is_filtered};
pub use ray_origin::RayOrigin;
pub use request::{Model, Region, RenderRequest};
pub use show::Show;
pub use tests_spared::tests_spared;
pub use view::View;
