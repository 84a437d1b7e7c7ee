//! One slanted triangle as large as the scene: all the work there is belongs to one primitive.

use super::glb::{Corner, Document};
use glam::Vec3;
use gltf::json::Material;

/// In metres: half of a square of 2 m by 2 m seen along z, with a slope of 2/5 along x and 3/10 along y.
pub const CORNERS: [Vec3; 3] =
    [Vec3::new(-1.0, -1.0, -0.7), Vec3::new(1.0, -1.0, 0.1), Vec3::new(-1.0, 1.0, -0.1)];

/// The file.
pub fn make() -> Vec<u8> {
    let [a, b, c] = CORNERS;
    let normal = (b - a).cross(c - a).normalize();
    let mut document = Document::default();
    document.root.asset.generator = Some("voxgi".to_owned());
    let material = document.material(Material::default());
    let vertices = CORNERS.map(|position| Corner { position, normal });
    document.triangles("triangle", &vertices, &[[0, 1, 2]], material);
    document.into_bytes()
}
