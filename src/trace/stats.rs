//! Ray counters.

use std::ops::{Add, AddAssign};

use serde::Serialize;

/// The numbers of rays that were traced, by their purpose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Rays {
    /// From the camera.
    pub camera: u64,
    /// From a surface to a light.
    pub shadow: u64,
    /// From a mirror.
    pub reflected: u64,
    /// From the camera for the second time, in double precision, where rounding may have decided what was seen. Rays
    /// that go on from these are not counted.
    pub again: u64,
}

impl Rays {
    /// The number of all rays.
    pub fn total(self) -> u64 {
        self.camera + self.shadow + self.reflected + self.again
    }
}

impl AddAssign for Rays {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Add for Rays {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            camera: self.camera + other.camera,
            shadow: self.shadow + other.shadow,
            reflected: self.reflected + other.reflected,
            again: self.again + other.again,
        }
    }
}
