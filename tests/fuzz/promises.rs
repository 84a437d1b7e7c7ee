//! What the loader promises about every scene, and every message about itself.

use crate::campaign::Answer;
use voxgi::problem::{Kind, Problems};
use voxgi::scene::{Scene, features};

/// Panics unless every index of the scene is in range and every number finite, as [`Scene`] says.
pub fn scene(scene: &Scene) {
    let (vertices, instances, materials) =
        (scene.vertices.len(), scene.instances.len(), scene.materials.len());
    for triangle in &scene.triangles {
        let corners = [triangle.a, triangle.b, triangle.c];
        assert!(
            corners.iter().all(|corner| (*corner as usize) < vertices),
            "a corner is beyond the vertices"
        );
        assert!((triangle.instance as usize) < instances, "an instance is beyond the instances");
    }
    assert!(
        scene.instances.iter().all(|i| (i.material as usize) < materials),
        "a material is beyond the materials"
    );
    let finite = |words: &[u8]| floats(words).all(f32::is_finite);
    for vertex in &scene.vertices {
        assert!(
            vertex.position.is_finite() && vertex.u.is_finite() && vertex.v.is_finite(),
            "a vertex is not finite"
        );
        assert!((vertex.normal.length() - 1.0).abs() < 1e-3, "a normal has no unit length");
    }
    for instance in &scene.instances {
        assert!(finite(bytemuck::bytes_of(&instance.to_world)), "a transform is not finite");
        assert!(
            finite(bytemuck::bytes_of(&instance.normal_to_world)),
            "a transform of normals is not finite"
        );
    }
    for material in &scene.materials {
        let parts = [material.base_color, material.emission];
        assert!(
            parts.iter().all(|part| part.is_finite() && part.min_element() >= 0.0),
            "a material is not finite"
        );
        assert!((0.0..=1.0).contains(&material.roughness) && (0.0..=1.0).contains(&material.metallic));
        assert!(material.alpha_cutoff.is_finite());
        for image in [material.base_color_image, material.emission_image] {
            assert!(
                image.y == 0 || in_texels(scene, [image.x, image.y, image.z, image.w >> 8]),
                "an image is beyond the texels"
            );
        }
    }
    for light in &scene.lights {
        let parts = [light.position, light.direction, light.intensity];
        assert!(parts.iter().all(|part| part.is_finite()), "a light is not finite");
        assert!(light.cos_inner.is_finite() && light.cos_outer.is_finite(), "a spot is not finite");
        assert!(
            (light.first_view + light.view_count) as usize <= scene.views.len(),
            "a view is beyond the views"
        );
    }
    for view in &scene.views {
        assert!(finite(bytemuck::bytes_of(view)), "a view is not finite");
    }
    assert!(!scene.cameras.is_empty(), "there is no camera");
    for camera in &scene.cameras {
        let camera = camera.uniform(1.5);
        assert!(finite(bytemuck::bytes_of(&camera)), "a camera is not finite");
    }
    assert!(scene.bounds.min.is_finite() && scene.bounds.max.is_finite(), "the bounds are not finite");
    for (name, feature) in features::features(scene) {
        let finite = match feature {
            features::Feature::Number(number) => number.is_finite(),
            features::Feature::Vector(numbers) => numbers.iter().all(|number| number.is_finite()),
            features::Feature::Flag(_) => true,
        };
        assert!(finite, "{name} is not finite");
    }
}

/// Whether an image of so many levels ends within the texels.
fn in_texels(scene: &Scene, [offset, width, height, levels]: [u32; 4]) -> bool {
    let level = |i: u32| u64::from((width >> i).max(1)) * u64::from((height >> i).max(1));
    let end = u64::from(offset) + (0..levels & 255).map(level).sum::<u64>();
    levels & 255 > 0 && end <= scene.texels.len() as u64
}

fn floats(bytes: &[u8]) -> impl Iterator<Item = f32> {
    bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
}

/// Panics unless the problems are the user's and can be shown. The answer has their words without what is the input's own.
pub fn problems(problems: &Problems) -> Answer {
    let mut words = String::new();
    for problem in problems.iter() {
        assert!(problem.kind == Kind::Input, "not the user's: {}", problem.message);
        assert!(!problem.message.is_empty() && !problem.code.is_empty(), "an empty message");
        let length = problem.message.len() + problem.help.as_ref().map_or(0, String::len);
        assert!(length < 10_000, "a message of thousands of characters: {}", problem.code);
        for (place, label) in &problem.labels {
            let (line, column) = place.line_column();
            assert!(line > 0 && column > 0 && label.len() < 10_000 && place.text().len() < 1 << 30);
        }
        assert!(!problem.render(false).is_empty() && problem.to_json().is_object());
        let quoted = problem.message.split(['`', '"']).step_by(2);
        let plain = quoted.flat_map(str::chars).filter(|c| c.is_ascii_alphabetic() || *c == ' ');
        words.push_str(problem.code);
        words.extend(plain.take(24));
    }
    Answer { accepted: false, words }
}
