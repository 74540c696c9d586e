//! Skinning of glTF meshes: each point is the weighted mean of where its joints move it.

use glam::{DMat4, DVec3};
use gltf::accessor::{DataType, Dimensions};
use gltf::mesh::Primitive;
use gltf::{Semantic, Skin};

use super::error::Fault;
use super::gltf_buffers::{Buffers, refused};

/// How the points of a node's mesh are placed in the scene.
pub(super) enum Placing {
    /// By the node's own transform.
    Whole(DMat4),
    /// By the joints of a skin, regardless of the node's own transform.
    Joints(Vec<DMat4>),
}

/// Joint indices and weights of each point of a primitive.
pub(super) struct Hung {
    joints: Vec<[f32; 4]>,
    weights: Vec<[f32; 4]>,
}

impl Placing {
    /// The placing by a skin; `places` holds the global transform of each node.
    pub(super) fn of_skin(skin: &Skin, places: &[DMat4], buffers: &Buffers) -> Result<Self, Fault> {
        let unbound = match skin.inverse_bind_matrices() {
            None => Vec::new(),
            Some(accessor) => {
                let kind = (DataType::F32, Dimensions::Mat4);
                if (accessor.data_type(), accessor.dimensions()) != kind {
                    let why = "holds skin matrices that are not sixteen floats each";
                    return Err(refused(&accessor, why));
                }
                buffers.numbers::<16>(&accessor)?
            }
        };
        let joints = skin.joints().enumerate().map(|(number, joint)| {
            let place = places
                .get(joint.index())
                .copied()
                .unwrap_or(DMat4::IDENTITY);
            match unbound.get(number) {
                Some(matrix) => place * DMat4::from_cols_array(&matrix.map(f64::from)),
                None => place,
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
    pub(super) fn hung(
        &self,
        primitive: &Primitive,
        points: usize,
        buffers: &Buffers,
    ) -> Result<Option<Hung>, Fault> {
        let joints = primitive.get(&Semantic::Joints(0));
        let weights = primitive.get(&Semantic::Weights(0));
        let (Self::Joints(_), Some(joints), Some(weights)) = (self, joints, weights) else {
            return Ok(None);
        };
        for accessor in [&joints, &weights] {
            if accessor.dimensions() != Dimensions::Vec4 || accessor.count() != points {
                let why = "does not hold four joints or weights for each point";
                return Err(refused(accessor, why));
            }
        }
        Ok(Some(Hung {
            joints: buffers.numbers(&joints)?,
            weights: buffers.numbers(&weights)?,
        }))
    }

    /// Returns the position of a point in the scene. The matrices are affine: their last row is 0 0 0 1.
    pub(super) fn place(&self, point: DVec3, index: usize, hung: Option<&Hung>) -> DVec3 {
        let joints = match self {
            Self::Whole(matrix) => return matrix.transform_point3(point),
            Self::Joints(joints) => joints,
        };
        let shares =
            hung.and_then(|hung| Some((hung.joints.get(index)?, hung.weights.get(index)?)));
        let (mut sum, mut total) = (DVec3::ZERO, 0.0);
        if let Some((numbers, weights)) = shares {
            for (&number, &weight) in numbers.iter().zip(weights) {
                // Joint indices have at most two bytes, so they are exact in single precision.
                if let Some(joint) = joints.get(number as usize) {
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
