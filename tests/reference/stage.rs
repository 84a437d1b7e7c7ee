//! Scenes made for one test, in memory.

use glam::{DVec3, Vec3, Vec4};
use voxgi::scene::layout::{
    DIRECTIONAL, Instance, Light, Material, POINT, SPOT, Triangle, Vertex, VertexExtra,
};
use voxgi::scene::{Bounds, Camera, Image, Lens, Scene};

/// What is on it is added piece by piece.
pub struct Stage(Scene);

/// A quadrilateral from its middle and half its sides; the front is where `right × up` points.
pub fn quad(middle: Vec3, right: Vec3, up: Vec3) -> [[Vec3; 3]; 2] {
    let [a, b, c, d] = [middle - right - up, middle + right - up, middle + right + up, middle - right + up];
    [[a, b, c], [a, c, d]]
}

/// Six squares around the origin at distance 1 whose fronts are inside.
pub fn room() -> Vec<[Vec3; 3]> {
    let axes = [Vec3::X, Vec3::Y, Vec3::Z];
    let walls = (0..3).flat_map(|i| {
        let [normal, right, up] = [axes[i], axes[(i + 1) % 3], axes[(i + 2) % 3]];
        [quad(-normal, right, up), quad(normal, up, right)]
    });
    walls.flatten().collect()
}

/// Lambert, of one colour.
pub fn matt(albedo: Vec3) -> Material {
    Material { base_color: albedo, roughness: 1.0, normal_scale: 1.0, ..bytemuck::Zeroable::zeroed() }
}

/// Emits from its front, and reflects nothing.
pub fn lamp(radiance: Vec3) -> Material {
    Material { emission: radiance, ..matt(Vec3::ZERO) }
}

pub fn point(position: Vec3, intensity: Vec3) -> Light {
    Light {
        position,
        intensity,
        kind: POINT,
        cos_inner: -1.0,
        cos_outer: -1.0,
        ..bytemuck::Zeroable::zeroed()
    }
}

/// `degrees`: half angles, inner and outer.
pub fn spot(position: Vec3, direction: Vec3, intensity: Vec3, degrees: [f32; 2]) -> Light {
    let [cos_inner, cos_outer] = degrees.map(|angle| angle.to_radians().cos());
    Light { kind: SPOT, direction, cos_inner, cos_outer, ..point(position, intensity) }
}

pub fn directional(direction: Vec3, irradiance: Vec3) -> Light {
    Light { kind: DIRECTIONAL, direction, ..point(Vec3::ZERO, irradiance) }
}

impl Stage {
    pub fn new() -> Self {
        Self(Scene { name: "stage".to_owned(), ..Scene::default() })
    }

    /// Triangles of one material, each flat.
    pub fn surface(mut self, triangles: &[[Vec3; 3]], material: Material) -> Self {
        let scene = &mut self.0;
        let instance = Instance {
            to_world: [Vec4::X, Vec4::Y, Vec4::Z, Vec4::ZERO],
            normal_to_world: [Vec4::X, Vec4::Y, Vec4::Z],
            material: scene.materials.len() as u32,
            flip: 1.0,
            pad: [0; 2],
        };
        scene.materials.push(material);
        for [a, b, c] in triangles {
            let first = scene.vertices.len() as u32;
            let normal = (b - a).cross(c - a).normalize_or(Vec3::Y);
            let corner = |position: &Vec3| Vertex { position: *position, u: 0.0, normal, v: 0.0 };
            scene.vertices.extend([a, b, c].map(corner));
            let instance = scene.instances.len() as u32;
            scene.triangles.push(Triangle { a: first, b: first + 1, c: first + 2, instance });
        }
        scene.instances.push(instance);
        self
    }

    /// Two triangles of a rectangle with an image of two texels side by side, the scene's only one; tangents go to the right.
    pub fn imaged(self, rectangle: &[[Vec3; 3]; 2], material: Material, texels: [[u8; 4]; 2]) -> Self {
        let first = self.0.vertices.len();
        let Self(mut scene) = self.surface(rectangle, material);
        for vertex in &mut scene.vertices[first..] {
            (vertex.u, vertex.v) = (if vertex.position.x < 0.0 { 0.0 } else { 1.0 }, 0.5);
        }
        scene.vertex_extras = vec![VertexExtra::NONE; first];
        let tangent = Vec4::new(1.0, 0.0, 0.0, 1.0);
        scene.vertex_extras.resize(scene.vertices.len(), VertexExtra { tangent, ..VertexExtra::NONE });
        let extremes = |of: fn(u8, u8) -> u8| [0, 1, 2, 3].map(|i| of(texels[0][i], texels[1][i]));
        scene.images = vec![Image {
            name: "halves".to_owned(),
            offset: 0,
            width: 2,
            height: 1,
            levels: 1,
            srgb: false,
            least: extremes(u8::min),
            greatest: extremes(u8::max),
        }];
        scene.texels = texels.map(u32::from_le_bytes).to_vec();
        Self(scene)
    }

    pub fn light(mut self, light: Light) -> Self {
        self.0.lights.push(light);
        self
    }

    /// A pinhole with a full angle of 90°.
    pub fn seen_from(self, eye: DVec3, direction: DVec3) -> Scene {
        self.through(eye, direction, Lens::Perspective { vertical_fov: 90f64.to_radians() })
    }

    /// By parallel rays: a square of twice `half` metres a side.
    pub fn seen_along(self, eye: DVec3, direction: DVec3, half: f64) -> Scene {
        self.through(eye, direction, Lens::Orthographic { half_height: half, far: 100.0 })
    }

    fn through(self, eye: DVec3, direction: DVec3, lens: Lens) -> Scene {
        let mut scene = self.0;
        let camera = Camera::looking("test", eye, direction, -DVec3::Z).expect("a direction");
        scene.cameras.push(Camera { lens, near: 1e-3, ..camera });
        scene.still_triangles = scene.triangles.len();
        scene.bounds = Bounds::around(scene.vertices.iter().map(|v| v.position)).unwrap_or_default();
        scene
    }
}
