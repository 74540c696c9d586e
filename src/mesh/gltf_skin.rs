//! Skinning of glTF meshes: each point is the weighted mean of where its joints move it.

use glam::{DMat4, DVec3};
use gltf::accessor::{DataType, Dimensions};
use gltf::mesh::Primitive;
use gltf::{Semantic, Skin};

use super::error::Fault;
use super::gltf_buffers::{Buffers, accessor_fault};

/// How the points of a node's mesh are placed in the scene.
pub(super) enum Placement {
    /// By the node's own transform.
    Whole(DMat4),
    /// By the joints of a skin, regardless of the node's own transform.
    Joints(Vec<DMat4>),
}

/// Four joint indices or weights for each point.
type FourPerPoint = Vec<[f32; 4]>;

/// Joint indices and weights of each point of a primitive, in sets of four.
pub(super) struct SkinWeights {
    sets: Vec<(FourPerPoint, FourPerPoint)>,
}

impl Placement {
    /// The placement by a skin; `transforms` holds the global transform of each node.
    pub(super) fn of_skin(
        skin: &Skin,
        transforms: &[DMat4],
        buffers: &Buffers,
    ) -> Result<Self, Fault> {
        let inverse_binds = match skin.inverse_bind_matrices() {
            None => Vec::new(),
            Some(accessor) => {
                let expected = (DataType::F32, Dimensions::Mat4);
                if (accessor.data_type(), accessor.dimensions()) != expected {
                    let why = "holds skin matrices that are not sixteen floats each";
                    return Err(accessor_fault(&accessor, why));
                }
                buffers.numbers::<16>(&accessor)?
            }
        };
        let joints = skin.joints().enumerate().map(|(number, joint)| {
            let transform = transforms
                .get(joint.index())
                .copied()
                .unwrap_or(DMat4::IDENTITY);
            match inverse_binds.get(number) {
                Some(matrix) => transform * DMat4::from_cols_array(&matrix.map(f64::from)),
                None => transform,
            }
        });
        Ok(Self::Joints(joints.collect()))
    }

    /// Returns whether it mirrors, and so turns faces inside out.
    pub(super) fn is_mirror(&self) -> bool {
        let first = match self {
            Self::Whole(matrix) => Some(matrix),
            Self::Joints(joints) => joints.first(),
        };
        first.is_some_and(|matrix| matrix.determinant() < 0.0)
    }

    /// Reads the joints and weights of a primitive with this number of points; `None` if it is not skinned.
    pub(super) fn read_weights(
        &self,
        primitive: &Primitive,
        points: usize,
        buffers: &Buffers,
    ) -> Result<Option<SkinWeights>, Fault> {
        let Self::Joints(_) = self else {
            return Ok(None);
        };
        let mut sets = Vec::new();
        for set in 0.. {
            let joints = primitive.get(&Semantic::Joints(set));
            let Some((joints, weights)) = joints.zip(primitive.get(&Semantic::Weights(set))) else {
                break;
            };
            for accessor in [&joints, &weights] {
                if accessor.dimensions() != Dimensions::Vec4 || accessor.count() != points {
                    let why = "does not hold four joints or weights for each point";
                    return Err(accessor_fault(accessor, why));
                }
            }
            sets.push((buffers.numbers(&joints)?, buffers.numbers(&weights)?));
        }
        Ok((!sets.is_empty()).then_some(SkinWeights { sets }))
    }

    /// Returns the position of a point in the scene. The matrices are affine: their last row is 0 0 0 1.
    pub(super) fn position(
        &self,
        point: DVec3,
        index: usize,
        skin_weights: Option<&SkinWeights>,
    ) -> DVec3 {
        let joints = match self {
            Self::Whole(matrix) => return matrix.transform_point3(point),
            Self::Joints(joints) => joints,
        };
        let sets = skin_weights.iter().flat_map(|weights| &weights.sets);
        let influences =
            sets.filter_map(|(joints, weights)| joints.get(index).zip(weights.get(index)));
        let (mut sum, mut total) = (DVec3::ZERO, 0.0);
        for (joint_indices, weights) in influences {
            for (&joint_index, &weight) in joint_indices.iter().zip(weights) {
                // Joint indices have at most two bytes, so they are exact in single precision.
                if let Some(joint) = joints.get(joint_index as usize) {
                    sum += joint.transform_point3(point) * f64::from(weight);
                    total += f64::from(weight);
                }
            }
        }
        if total > 0.0 {
            sum / total
        } else {
            joints
                .first()
                .map_or(point, |joint| joint.transform_point3(point))
        }
    }
}
