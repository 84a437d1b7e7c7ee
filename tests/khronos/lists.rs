//! What the loader makes of the models' lists: triangles, sparse and quantized numbers, colours, materials.

use super::models::{Model, folder};
use glam::{DVec2, DVec3, Mat4, Vec3};
use voxgi::scene::layout::{DOUBLE_SIDED, UNLIT, Vertex};

/// Of an image reference; see `voxgi::scene::Image::reference`.
const SECOND_UV: u32 = 1 << 6;
use voxgi::scene::{Scene, load};

fn place(scene: &Scene, instance: u32, point: Vec3) -> DVec3 {
    let columns = scene.instances[instance as usize].to_world;
    let [x, y, z, w] = columns.map(|column| column.truncate().as_dvec3());
    let p = point.as_dvec3();
    x * p.x + y * p.y + z * p.z + w
}

/// Corners of each triangle, in the world, and its vertices.
fn triangles(scene: &Scene) -> Vec<([DVec3; 3], [Vertex; 3])> {
    let triangle = |t: &voxgi::scene::layout::Triangle| {
        let vertices = [t.a, t.b, t.c].map(|i| scene.vertices[i as usize]);
        (vertices.map(|vertex| place(scene, t.instance, vertex.position)), vertices)
    };
    scene.triangles.iter().map(triangle).collect()
}

/// Six triangles around a hexagon's centre in each mode; strips leave out two corners.
#[test]
fn mesh_primitive_modes() {
    let Some(folder) = folder() else { return };
    let scene = load(&folder.join("MeshPrimitiveModes.gltf")).expect("it loads");
    let lacks: Vec<String> = scene.lacks.iter().map(ToString::to_string).collect();
    assert_eq!(lacks, ["4 primitives of points or lines are left out"]);
    let counts = [0, 1, 2].map(|i| scene.triangles.iter().filter(|t| t.instance == i).count());
    assert_eq!(counts, [6, 4, 6]);
    let doubled = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a);
    let areas: Vec<DVec3> = triangles(&scene).into_iter().map(|(corners, _)| doubled(corners)).collect();
    let total = |range: std::ops::Range<usize>| areas[range].iter().sum::<DVec3>();
    // All of the list and the fan wind alike: nothing cancels.
    assert!((total(0..6) - total(10..16)).length() < 1e-9, "{} {}", total(0..6), total(10..16));
    let sizes: f64 = areas[..6].iter().map(|area| area.length()).sum();
    assert!((sizes - total(0..6).length()).abs() < 1e-9 && sizes > 1.0);
    let strip: f64 = areas[6..10].iter().map(|area| area.length()).sum();
    assert!((strip - total(6..10).length()).abs() < 1e-9 && strip > 0.5);
}

/// A row of squares of which three upper corners are pulled up by the sparse part.
#[test]
fn simple_sparse_accessor() {
    let Some(folder) = folder() else { return };
    let scene = load(&folder.join("SimpleSparseAccessor.gltf")).expect("it loads");
    let corners = triangles(&scene);
    assert_eq!(corners.len(), 12);
    let has = |x: f64, y: f64| corners.iter().any(|(c, _)| c.contains(&DVec3::new(x, y, 0.0)));
    for (x, y) in [(1.0, 2.0), (3.0, 3.0), (5.0, 4.0)] {
        assert!(has(x, y), "({x}, {y}) is there");
        assert!(!has(x, 1.0), "and not where the plain part has it");
    }
}

/// The same duck, as far as its numbers are fine: a step of positions, and of texture coordinates behind the transform.
#[test]
fn duck_quantized() {
    let Some(folder) = folder() else { return };
    let [plain, quantized] =
        ["Duck.glb", "Duck-Quantized.glb"].map(|name| load(&folder.join(name)).expect("it loads"));
    let step = 0.000_101_006_161;
    let material = &quantized.materials[quantized.instances[0].material as usize];
    let [x, y, z] = material.base_color_uv.map(|column| column.as_dvec2());
    let ducks = [triangles(&plain), triangles(&quantized)];
    assert_eq!([ducks[0].len(), ducks[1].len()], [4212; 2]);
    let mut worst = [0.0f64; 2];
    for (corners, vertices) in &ducks[0] {
        // Triangles come in another order.
        let apart = |other: &[DVec3; 3]| (0..3).map(|i| corners[i].distance(other[i])).fold(0.0, f64::max);
        let turns = |k: usize| ducks[1].iter().map(move |(c, v)| (k, [0, 1, 2].map(|i| c[(i + k) % 3]), v));
        let nearest = (0..3).flat_map(turns).min_by(|a, b| apart(&a.1).total_cmp(&apart(&b.1)));
        let (turn, other, found) = nearest.expect("there are triangles");
        worst[0] = worst[0].max(apart(&other) / step);
        for (i, vertex) in vertices.iter().enumerate() {
            let raw = found[(i + turn) % 3];
            let uv = x * f64::from(raw.u) + y * f64::from(raw.v) + z;
            let off = uv - DVec2::new(vertex.u.into(), vertex.v.into());
            worst[1] = worst[1].max(off.abs().max_element() / x.x);
        }
    }
    println!("{} steps of positions, {} of texture coordinates", worst[0], worst[1]);
    // Each number is rounded to the nearest step: half the diagonal of a cube of one step.
    assert!(worst[0] < 0.9 && worst[1] < 0.6, "{worst:?}");
}

#[test]
fn box_vertex_colors() {
    let Some(model) = Model::read("BoxVertexColors") else { return };
    let scene = model.load();
    let colors = model.numbers(0, "COLOR_0");
    assert_eq!(scene.vertex_extras.len(), colors.len() / 3);
    for (extra, color) in scene.vertex_extras.iter().zip(colors.chunks_exact(3)) {
        let found = extra.unpacked_color();
        let off = (0..3).map(|i| (f64::from(found[i]) - color[i]).abs()).fold(0.0, f64::max);
        assert!(off < 1e-3 && found[3] == 1.0, "{found:?} {color:?}");
    }
    assert!(colors.iter().any(|c| *c != colors[0]), "they are not all the same");
}

#[test]
fn multi_uv_test() {
    let Some(model) = Model::read("MultiUVTest") else { return };
    let scene = model.load();
    let [first, second] = ["TEXCOORD_0", "TEXCOORD_1"].map(|name| model.numbers(0, name));
    assert_ne!(first, second);
    for (i, (vertex, extra)) in scene.vertices.iter().zip(&scene.vertex_extras).enumerate() {
        let found = [vertex.u, vertex.v, extra.uv.x, extra.uv.y].map(f64::from);
        assert_eq!(found, [first[2 * i], first[2 * i + 1], second[2 * i], second[2 * i + 1]]);
    }
    let material = &scene.materials[0];
    assert_eq!(material.base_color_image.w & SECOND_UV, 0);
    assert_ne!(material.emission_image.w & SECOND_UV, 0);
}

#[test]
fn box_textured_non_power_of_two() {
    let Some(model) = Model::read("BoxTexturedNonPowerOfTwo") else { return };
    let scene = model.load();
    let [image] = &scene.images[..] else { panic!("one image") };
    assert!(!image.width.is_power_of_two(), "as it is in the file: {} × {}", image.width, image.height);
    assert_eq!(image.levels, image.width.max(image.height).ilog2() + 1);
    let uvs = model.numbers(0, "TEXCOORD_0");
    let found: Vec<f64> = scene.vertices.iter().flat_map(|v| [v.u.into(), v.v.into()]).collect();
    assert_eq!(found, uvs);
}

#[test]
fn emissive_strength_and_unlit() {
    let Some(folder) = folder() else { return };
    let scene = load(&folder.join("EmissiveStrengthTest.glb")).expect("it loads");
    let mut emissions: Vec<f32> = scene.materials.iter().map(|m| m.emission.z).filter(|e| *e > 0.0).collect();
    emissions.sort_by(f32::total_cmp);
    assert_eq!(emissions, [1.0, 2.0, 4.0, 8.0, 16.0].map(|strength| 0.9 * strength));
    let scene = load(&folder.join("UnlitTest.glb")).expect("it loads");
    assert!(scene.materials.iter().all(|material| material.flags == UNLIT | DOUBLE_SIDED));
}

/// For each arrow how far it points from the target of its colour, in degrees, at worst.
fn worst_arrow(scene: &Scene) -> f64 {
    let mut centers = vec![(DVec3::ZERO, 0.0); scene.instances.len()];
    for (t, (corners, _)) in scene.triangles.iter().zip(triangles(scene)) {
        let center = &mut centers[t.instance as usize];
        *center = (center.0 + corners.iter().sum::<DVec3>(), center.1 + 3.0);
    }
    let of = |material: u32| {
        let parts = scene.instances.iter().zip(&centers).filter(move |(i, _)| i.material == material);
        parts.map(|(_, (sum, count))| sum / count).collect::<Vec<_>>()
    };
    let mut worst = 0.0f64;
    for (material, axis) in (1..7).zip([DVec3::X, DVec3::X, DVec3::Y, DVec3::Y, DVec3::Z, DVec3::Z]) {
        let centers: Vec<DVec3> = of(material).iter().map(|center| center.reject_from(axis)).collect();
        let [a, b] = centers[..] else { panic!("an arrow and a target") };
        worst = worst.max(a.angle_between(b).to_degrees());
    }
    worst
}

#[test]
fn orientation_test() {
    let Some(folder) = folder() else { return };
    let mut scene = load(&folder.join("OrientationTest.glb")).expect("it loads");
    let found = worst_arrow(&scene);
    println!("arrows point {found}° off at most");
    assert!(found < 3.0);
    for instance in &mut scene.instances {
        let [_, _, _, to] = instance.to_world;
        let [x, y, z, _] = Mat4::IDENTITY.to_cols_array_2d().map(glam::Vec4::from);
        instance.to_world = [x, y, z, to];
    }
    assert!(worst_arrow(&scene) > 10.0, "without its turn");
}

/// How many triangles face against their corners' normals.
fn turned(scene: &Scene) -> usize {
    let against = |(t, (corners, vertices)): (&voxgi::scene::layout::Triangle, ([DVec3; 3], [Vertex; 3]))| {
        let instance = &scene.instances[t.instance as usize];
        let [a, b, c] = corners;
        let face = (b - a).cross(c - a) * f64::from(instance.flip);
        let [x, y, z] = instance.normal_to_world.map(|column| column.truncate().as_dvec3());
        let sum: DVec3 = vertices.iter().map(|v| v.normal.as_dvec3()).sum();
        face.dot(x * sum.x + y * sum.y + z * sum.z) < 0.0
    };
    scene.triangles.iter().zip(triangles(scene)).filter(|pair| against((pair.0, pair.1))).count()
}

/// Mirrored nodes are no inside-out ones: faces and normals stay on one side, and the squares of the column "front"
/// face the viewer at scale 1 as at scale -1, those of "back" do not. (Nothing is culled here, so that the picture shows the
/// crosses which are on the backs.)
#[test]
fn negative_scale_test() {
    let Some(folder) = folder() else { return };
    let mut scene = load(&folder.join("NegativeScaleTest.glb")).expect("it loads");
    assert!(scene.instances.iter().any(|instance| instance.flip < 0.0), "some are mirrored");
    let sides = |scene: &Scene| {
        let mut sides = Vec::new();
        for (t, (corners, _)) in scene.triangles.iter().zip(triangles(scene)) {
            let [a, b, c] = corners;
            let (center, material) = ((a + b + c) / 3.0, scene.instances[t.instance as usize].material);
            if material == 0 && (center.z - 0.1).abs() < 0.01 && center.x < 2.4 {
                let face = (b - a).cross(c - a).z * f64::from(scene.instances[t.instance as usize].flip);
                sides.push((center.x > 1.0, center.y > 2.0, face > 0.0));
            }
        }
        sides.sort_unstable();
        sides.dedup();
        sides
    };
    let wanted = vec![(false, false, true), (false, true, true), (true, false, false), (true, true, false)];
    assert_eq!((sides(&scene), turned(&scene)), (wanted.clone(), 0));
    scene.instances.iter_mut().for_each(|instance| instance.flip = 1.0);
    assert_ne!(sides(&scene), wanted, "without the flip");
    assert!(turned(&scene) > 100);
}
