//! Instances: mesh parts placed in the world.

use super::layout::Instance;
use glam::{DMat3, DMat4, DVec3, Vec4};

impl Instance {
    /// A mesh part of this material, placed by `to_world`.
    pub fn placed(to_world: &DMat4, material: u32) -> Self {
        let linear = DMat3::from_mat4(*to_world);
        let [x, y, z] = linear.to_cols_array_2d().map(DVec3::from);
        // The inverse transpose is the matrix of cofactors over the determinant.
        let determinant = linear.determinant();
        let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
        let inverse = cofactors * determinant.recip();
        let normals = if inverse.is_finite() && inverse.as_mat3().is_finite() {
            inverse
        } else {
            // For a mesh pressed flat there is no inverse, but the cofactors still turn normals right.
            let largest =
                cofactors.to_cols_array().into_iter().fold(0.0, |largest: f64, c| largest.max(c.abs()));
            cofactors * (if largest > 0.0 { largest.recip() } else { 1.0 }) * determinant.signum()
        };
        Self {
            to_world: to_world
                .to_cols_array_2d()
                .map(|[x, y, z, _]| Vec4::new(x as f32, y as f32, z as f32, 0.0)),
            normal_to_world: [normals.x_axis, normals.y_axis, normals.z_axis]
                .map(|column| column.as_vec3().extend(0.0)),
            material,
            flip: if determinant < 0.0 { -1.0 } else { 1.0 },
            pad: [0; 2],
        }
    }
}
