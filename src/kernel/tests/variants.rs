//! The cache of variants: equal ones share, and nothing that differs does.

use super::*;
use crate::kernel::{Choice, Variants};
use naga::valid::Capabilities;
use std::sync::Arc;
use wgpu_types::TextureFormat;

const TEXT: &str = "
override gain: f32 = 1.0;
@if(bright) const BASE = 2.0; @else const BASE = 1.0;
var<storage> source: array<f32>;
var image: texture_storage_2d<rgba16float, write>;
@compute @workgroup_size(1) fn run() { textureStore(image, vec2u(), vec4f(gain * BASE * source[0])); }
@compute @workgroup_size(1) fn other() { textureStore(image, vec2u(), vec4f()); }";

struct Case {
    bright: bool,
    gain: Option<f64>,
    entries: &'static [&'static str],
    choice: Choice,
    role: Option<&'static str>,
}

impl Case {
    fn new() -> Self {
        Self { bright: true, gain: None, entries: &["run"], choice: Choice::default(), role: None }
    }

    fn program(&self, files: &Files, variants: &mut Variants) -> Arc<crate::kernel::Program> {
        let names = known(&[("bright", Value::Flag(self.bright))]);
        let modules: Vec<(&str, &str)> = self.role.map(|role| (role, "module")).into_iter().collect();
        let kernel = self.role.unwrap_or("plain");
        let roles = modules.iter().map(|(role, module)| ((*role).to_owned(), (*module).to_owned())).collect();
        let at = Source::new("pipeline.ron", "").at(0..0);
        let composed = compose(&files.library, kernel, &at, &roles, &names).unwrap();
        let overrides = self.gain.map(|gain| ("gain".to_owned(), gain)).into_iter().collect();
        let reflected = variants.reflect(&composed, &overrides).unwrap();
        variants.finish(&reflected, self.entries, &self.choice).unwrap()
    }
}

fn files() -> Files {
    Files::new(&[("plain", TEXT), ("module", TEXT), ("a", "import role/a;"), ("b", "import role/b;")])
}

#[test]
fn equal_variants_are_one_program() {
    let (files, mut variants) = (files(), Variants::default());
    let first = Case::new().program(&files, &mut variants);
    let same = [
        Case::new(),
        Case { choice: formats("image", TextureFormat::Rgba16Float), ..Case::new() },
        Case { choice: formats("nothing", TextureFormat::R32Float), ..Case::new() },
        Case { choice: writable("image"), ..Case::new() },
    ];
    for case in same {
        assert!(Arc::ptr_eq(&first, &case.program(&files, &mut variants)));
    }
    assert_eq!((variants.hits, variants.misses), (4, 1));
}

#[test]
fn variants_that_differ_in_anything_are_not() {
    let (files, mut variants) = (files(), Variants::default());
    let different = [
        Case::new(),
        Case { bright: false, ..Case::new() },
        Case { gain: Some(2.0), ..Case::new() },
        Case { gain: Some(2.0 + f64::EPSILON * 2.0), ..Case::new() },
        Case { entries: &["other"], ..Case::new() },
        Case { entries: &["run", "other"], ..Case::new() },
        Case { choice: formats("image", TextureFormat::Rgba8Unorm), ..Case::new() },
        Case { choice: formats("image", TextureFormat::R32Float), ..Case::new() },
        Case { choice: writable("source"), ..Case::new() },
        Case { choice: Choice { capabilities: Capabilities::empty(), ..Choice::default() }, ..Case::new() },
        Case { role: Some("a"), ..Case::new() },
        Case { role: Some("b"), ..Case::new() },
    ];
    let programs: Vec<_> = different.iter().map(|case| case.program(&files, &mut variants)).collect();
    for (i, program) in programs.iter().enumerate() {
        assert!(
            programs[..i].iter().all(|other| !Arc::ptr_eq(program, other) && program.key != other.key),
            "{i}"
        );
    }
    assert_eq!((variants.hits, variants.misses), (0, different.len() as u64));
    for (case, program) in different.iter().zip(&programs) {
        assert!(Arc::ptr_eq(program, &case.program(&files, &mut variants)));
    }
    variants.clear();
    assert!(!Arc::ptr_eq(&programs[0], &different[0].program(&files, &mut variants)));
}

fn formats(binding: &str, format: TextureFormat) -> Choice {
    Choice { formats: BTreeMap::from([(binding.to_owned(), format)]), ..Choice::default() }
}

fn writable(binding: &str) -> Choice {
    Choice { writable: [binding.to_owned()].into(), ..Choice::default() }
}
