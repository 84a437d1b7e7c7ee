//! A folder of runs as a comparison writes it, with made-up numbers and small pictures.

use std::collections::BTreeMap;
use std::path::Path;
use voxgi::comparison::{
    Comparison, Memory, Pictures, Reference, Run, SCHEMA, SceneEntry, StageTime, Timing,
};
use voxgi::picture::{Curve, Encoded, Picture, write_encoded, write_png};
use voxgi::record::{Adapter, Spread};

pub const SIZE: u32 = 96;
pub const OUTPUTS: [&str; 4] = ["color", "direct", "indirect", "ambient_occlusion"];
/// The reference's noise, as relMSE.
const NOISE: f64 = 0.002;

/// A pipeline's name, what was set, and how long a frame of it takes.
struct Setting {
    pipeline: &'static str,
    set: Vec<(&'static str, String)>,
    ms: f64,
    error: f64,
}

/// Two scenes by three pipelines with knobs, or one scene and pipeline along two knobs and a part. Everything that the
/// comparison names is written into `folder`.
pub fn write(folder: &Path, command: &str) -> Comparison {
    let sweep = command == "sweep";
    let scenes: &[&str] = if sweep { &["cornell-box"] } else { &["cornell-box", "hall"] };
    let mut comparison = Comparison {
        schema: SCHEMA,
        command: command.to_owned(),
        name: format!("2026-11-22-{command}"),
        date: "2026-11-22T08:30:00Z".to_owned(),
        version: "0.1.0".to_owned(),
        adapter: Adapter {
            name: "llvmpipe (LLVM 15.0.6, 256 bits)".to_owned(),
            driver: "llvmpipe".to_owned(),
            driver_info: "Mesa 25.0.7".to_owned(),
            backend: "vulkan".to_owned(),
            kind: "Cpu".to_owned(),
        },
        size: [SIZE, SIZE],
        exposure: 0.5,
        curve: "reinhard".to_owned(),
        scenes: scenes.iter().enumerate().map(|(at, name)| scene(folder, name, at)).collect(),
        runs: Vec::new(),
    };
    for (at, scene) in scenes.iter().enumerate() {
        let settings = if sweep { swept() } else { compared() };
        for (number, setting) in settings.iter().enumerate() {
            comparison.runs.push(run(folder, scene, (at, number), setting));
        }
    }
    let text = serde_json::to_string_pretty(&comparison).expect("a comparison is JSON");
    std::fs::write(folder.join(voxgi::comparison::FILE), text).expect("the folder can be written to");
    comparison
}

fn compared() -> Vec<Setting> {
    let setting = |pipeline, set: &[(&'static str, &str)], ms, error| Setting {
        pipeline,
        set: set.iter().map(|(name, value)| (*name, (*value).to_owned())).collect(),
        ms,
        error,
    };
    vec![
        setting("alpha", &[], 42.0, 0.09),
        setting("alpha", &[("resolution", "128")], 130.0, 0.04),
        setting("alpha", &[("resolution", "128"), ("gather", "gather/many")], 310.0, 0.012),
        setting("beta", &[], 48.0, 0.2),
        setting("beta", &[("resolution", "128")], 140.0, 0.05),
        setting("gamma", &[], 900.0, 0.0015),
    ]
}

fn swept() -> Vec<Setting> {
    let mut settings = Vec::new();
    for resolution in [32, 64, 128] {
        for bounces in [0, 1, 3] {
            for gather in ["gather/few", "gather/many"] {
                let many = gather.ends_with("many");
                let size = f64::from(resolution) / 32.0;
                let ms =
                    4.0 * size.powf(1.6) * (1.0 + 0.4 * f64::from(bounces)) * if many { 2.5 } else { 1.0 };
                let error = 0.2 / size * 0.6_f64.powi(bounces) * if many { 0.5 } else { 1.0 } + 0.003;
                let mut set = vec![("resolution", resolution.to_string()), ("bounces", bounces.to_string())];
                set.push(("gather", gather.to_owned()));
                settings.push(Setting { pipeline: "alpha", set, ms, error });
            }
        }
    }
    settings
}

fn scene(folder: &Path, name: &str, at: usize) -> SceneEntry {
    let pictures = OUTPUTS.map(|output| {
        let stem = format!("{name}-reference-{output}");
        (output.to_owned(), pictures(folder, &stem, (at, output), None))
    });
    let by_output = |value: f64| OUTPUTS.map(|output| (output.to_owned(), value)).into_iter().collect();
    let reference = Reference {
        pipeline: "reference".to_owned(),
        knobs: BTreeMap::new(),
        samples: 4096,
        seconds: 83.2,
        cached_samples: 1024,
        noise: by_output(NOISE),
        mean: by_output(0.4),
        pictures: pictures.into_iter().collect(),
    };
    SceneEntry {
        name: name.to_owned(),
        file: format!("scenes/{name}.glb"),
        camera: "front".to_owned(),
        content: name.to_owned(),
        triangles: 38 + at * 262_229,
        lacks: if at == 1 { vec!["2 transmissive materials are rendered opaque".to_owned()] } else { vec![] },
        references: BTreeMap::from([("full".to_owned(), reference)]),
    }
}

fn run(folder: &Path, scene: &str, (at, number): (usize, usize), setting: &Setting) -> Run {
    let set: Vec<String> = setting.set.iter().map(|(name, value)| format!(" {name}={value}")).collect();
    let name = format!("{}{}", setting.pipeline, set.concat());
    let ms = setting.ms * (1.0 + at as f64 * 0.7);
    let errors = |factor: f64| -> BTreeMap<String, BTreeMap<String, f64>> {
        let of = |(index, output): (usize, &str)| {
            let e = setting.error * factor * (1.0 + index as f64 * 0.3);
            let values = [
                ("relmse", e),
                ("relmse_trimmed", e * 0.8),
                ("relmse_above_noise", (e - NOISE).max(0.0)),
                ("rmse", e.sqrt() * 0.4),
                ("smape", e.sqrt() * 0.7),
                ("flip", e.sqrt() * 0.3),
                ("ssim", 1.0 - e),
                ("bias", 1.0 - e * 0.8),
            ];
            (output.to_owned(), values.map(|(key, value)| (key.to_owned(), value)).into_iter().collect())
        };
        OUTPUTS.into_iter().enumerate().map(of).collect()
    };
    let many = name.contains("many");
    let stage = |path: &str, share: f64| {
        let kept = path == "voxelize";
        StageTime {
            path: path.to_owned(),
            status: if share == 0.0 {
                "dropped"
            } else if kept {
                "kept"
            } else {
                "run"
            }
            .to_owned(),
            reason: if share == 0.0 {
                Some("scene.moving is false".to_owned())
            } else {
                kept.then(|| "it depends on geometry, and that did not change".to_owned())
            },
            gpu_ms: (share > 0.0).then_some(ms * share),
            spread: Spread { p10: Some(ms * share * 0.95), p90: Some(ms * share * 1.1) },
            samples_ms: vec![Some(ms * share); 3],
        }
    };
    let mut stages = vec![stage("voxelize", 0.2), stage("moving/clear", 0.0), stage("light/inject", 0.08)];
    stages.extend((0..3).map(|level| stage(&format!("mips/level[{level}]"), 0.05)));
    stages.extend([
        stage("bounce/gather[1]", 0.15),
        stage("bounce/gather[2]", 0.12),
        stage("bounce/add", 0.04),
    ]);
    stages.extend([
        stage("surfaces", 0.06),
        stage("trace", 0.28),
        stage("filter/a", 0.03),
        stage("filter/b", 0.02),
    ]);
    stages.extend([stage("filter/c", 0.01), stage("display/tone", 0.04)]);
    if many {
        stages.push(stage("trace/second", 0.1));
    }
    let pictures = OUTPUTS.map(|output| {
        let stem = format!("{scene}-{number}-{output}");
        (output.to_owned(), pictures(folder, &stem, (at, output), Some((number, setting.error))))
    });
    let knob = |name: &str, default: u32| {
        let set = setting.set.iter().find(|(set, _)| *set == name);
        set.map_or(default, |(_, value)| value.parse().expect("a number")).into()
    };
    let part = setting.set.iter().find(|(set, _)| *set == "gather");
    Run {
        repeats_ms: vec![Some(ms)],
        documents: BTreeMap::new(),
        name,
        scene: scene.to_owned(),
        reference: "full".to_owned(),
        pipeline: setting.pipeline.to_owned(),
        parts: BTreeMap::from([(
            "gather".to_owned(),
            part.map_or("gather/few".to_owned(), |(_, part)| part.clone()),
        )]),
        knobs: BTreeMap::from([
            ("resolution".to_owned(), knob("resolution", 64)),
            ("bounces".to_owned(), knob("bounces", 1)),
        ]),
        set: setting.set.iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect(),
        clock: "timestamps".to_owned(),
        clock_reason: None,
        gpu_ms: Timing {
            median: Some(ms),
            p10: Some(ms * 0.95),
            p90: Some(ms * 1.12),
            samples: vec![Some(ms * 0.95), Some(ms), Some(ms * 1.12)],
        },
        first_use_ms: Some(ms + 850.0),
        encode_ms: Some(0.42),
        stages,
        errors: errors(1.0),
        masked: [("surface", 1.1), ("lit", 0.7), ("unlit", 1.9)]
            .map(|(mask, factor)| (mask.to_owned(), errors(factor)))
            .into_iter()
            .collect(),
        within_noise: if setting.error < NOISE {
            vec!["color".to_owned(), "direct".to_owned()]
        } else {
            vec![]
        },
        memory: Memory { peak_bytes: (ms * 300_000.0) as u64 },
        tuned: BTreeMap::new(),
        lacks: if setting.pipeline == "beta" {
            vec!["glossy surfaces are rendered matt".to_owned()]
        } else {
            vec![]
        },
        pictures: pictures.into_iter().collect(),
    }
}

/// Writes a picture (of the reference, or of run `number` with `error`) and, for a run, its maps.
fn pictures(folder: &Path, stem: &str, what: (usize, &str), run: Option<(usize, f64)>) -> Pictures {
    let truth = |x: u32, y: u32| radiance(what, x, y);
    let picture = pixels(|x, y| {
        let wrong = run.map_or(0.0, |(number, error)| wrong(number, error, x, y));
        truth(x, y).map(|c| (c * (1.0 + wrong)).max(0.0))
    });
    let png = format!("{stem}.png");
    write_png(&folder.join(&png), &picture, Curve::Reinhard, 0.5).expect("the folder can be written to");
    let map = |kind: &str, color: &dyn Fn(f32) -> [u8; 3]| {
        run.map(|(number, error)| {
            let rgba = (0..SIZE * SIZE).flat_map(|at| {
                let [r, g, b] = color(wrong(number, error, at % SIZE, at / SIZE));
                [r, g, b, 255]
            });
            let path = format!("{stem}-{kind}.png");
            let map = Encoded::new(SIZE, SIZE, rgba.collect()).expect("the size is right");
            write_encoded(&folder.join(&path), &map).expect("the folder can be written to");
            path
        })
    };
    let level = |share: f32| (share.clamp(0.0, 1.0) * 255.0) as u8;
    Pictures {
        exr: format!("{}.exr", stem.rsplit_once('-').map_or(stem, |(run, _)| run)),
        png,
        difference: map("difference", &|e| {
            [level(1.0 + e.min(0.0)), level(1.0 - e.abs()), level(1.0 - e.max(0.0))]
        }),
        flip: map("flip", &|e| [level(e.abs() * 1.5), level(e.abs() * 0.6), level(0.3 - e.abs() * 0.2)]),
    }
}

fn pixels(texel: impl Fn(u32, u32) -> [f32; 3]) -> Picture {
    let data = (0..SIZE * SIZE).flat_map(|at| texel(at % SIZE, at / SIZE)).collect();
    Picture::new(SIZE, SIZE, 3, data).expect("the size is right")
}

/// Three walls and a ball.
fn radiance((scene, output): (usize, &str), x: u32, y: u32) -> [f32; 3] {
    let (u, v) = (x as f32 / SIZE as f32 - 0.5, y as f32 / SIZE as f32 - 0.5);
    let wall = if u.abs() < 0.3 {
        [0.7, 0.7, 0.65]
    } else if u < 0.0 {
        [0.7, 0.1, 0.1]
    } else {
        [0.1, 0.5, 0.15]
    };
    let ball = ((u - 0.08).powi(2) + (v - 0.2).powi(2)).sqrt() < 0.18;
    let base = if ball { [0.3, 0.4, 0.8] } else { wall };
    let light = 0.25 + (0.9 - ((u * 1.2).powi(2) + (v + 0.5 - scene as f32 * 0.3).powi(2)).sqrt()).max(0.0);
    match output {
        "direct" => base.map(|c| c * light * if ball || v < 0.2 { 1.0 } else { 0.3 }),
        "indirect" => base.map(|c| c * 0.3),
        "ambient_occlusion" => [1.0 - u.abs() * if ball { 0.3 } else { 0.9 }; 3],
        _ => base.map(|c| c * light),
    }
}

/// The relative error of a pixel: smooth blotches, and one corner that is far off.
fn wrong(number: usize, error: f64, x: u32, y: u32) -> f32 {
    let (u, v) = (x as f32 / 9.0, y as f32 / 7.0);
    let corner = if x > 60 && y < 30 { 1.5 } else { 0.5 };
    (error as f32).sqrt() * corner * ((u + number as f32).sin() + (v * 1.3).cos())
}
