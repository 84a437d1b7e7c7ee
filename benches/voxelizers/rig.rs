//! Runs the methods on a scene in turns, and takes their times.

use crate::rows::{Cell, Row};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};
use voxgi::device::Gpu;
use voxgi::expr::Value;
use voxgi::frame::{Changes, Clock, Frame, Times};
use voxgi::library::Library;
use voxgi::problem::{Problem, Result};
use voxgi::record;
use voxgi::scene::Scene;
use voxgi::schedule::Step;
use voxgi::session::{Request, prepare};

/// The roles whose stages count.
const ROLES: [&str; 2] = ["payload/", "voxelize/"];
/// Under which name fills before stages are kept.
const FILLS: &str = "fills";

/// What all rows have in common.
pub struct Rig {
    pub gpu: Gpu,
    pub clock: Clock,
    pub library: Library,
    pub methods: Vec<String>,
    /// By method.
    pub cutoffs: BTreeMap<String, f64>,
    /// Rounds at most.
    pub repeats: u32,
    /// A method whose first frame takes longer is sampled once; and a row of so many methods takes so many times that.
    pub seconds: Duration,
}

/// A method that is ready to run.
struct Subject {
    frame: Frame,
    cell: Cell,
    slow: bool,
}

impl Rig {
    /// A row, which is to be done after `time`; each method is sampled at least once, however long that takes.
    pub fn measure(&self, scene: &Scene, resolution: u32, separability: u32, time: Duration) -> Result<Row> {
        let begun = Instant::now();
        let time = time.min(self.seconds.saturating_mul(self.methods.len() as u32));
        let start = |method: &String| self.start(scene, method, resolution, separability);
        let mut subjects: Vec<Subject> = self.methods.iter().map(start).collect::<Result<_>>()?;
        let mut longest = Duration::ZERO;
        for round in 0..self.repeats {
            let round_begun = Instant::now();
            if round > 0 && begun.elapsed() + longest > time {
                break;
            }
            let mut order: Vec<&mut Subject> =
                subjects.iter_mut().filter(|subject| round == 0 || !subject.slow).collect();
            if round % 2 == 1 {
                order.reverse();
            }
            for subject in order {
                subject.sample(&self.gpu)?;
            }
            longest = longest.max(round_begun.elapsed());
        }
        let mut voxels: Vec<Vec<u32>> = Vec::new();
        for subject in &subjects {
            voxels.push(filled(&subject.frame, &self.gpu, scene)?);
        }
        let first = voxels.first().map(Vec::as_slice).unwrap_or_default();
        let differ = subjects.iter().zip(&voxels).filter(|(_, own)| *own != first);
        Ok(Row {
            scene: scene.name.clone(),
            triangles: scene.triangles.len(),
            resolution,
            separability,
            filled: first.iter().map(|word| u64::from(word.count_ones())).sum(),
            differ: differ.map(|(subject, _)| subject.cell.method.clone()).collect(),
            cells: subjects.into_iter().map(|subject| subject.cell).collect(),
        })
    }

    /// Makes the frame and runs it twice: drivers compile in the first, and the second finds voxels to clear.
    fn start(&self, scene: &Scene, method: &str, resolution: u32, separability: u32) -> Result<Subject> {
        let mut sets = vec![
            ("resolution".to_owned(), resolution.to_string()),
            ("separability".to_owned(), separability.to_string()),
        ];
        sets.extend(self.cutoffs.get(method).map(|cutoff| ("cutoff".to_owned(), cutoff.to_string())));
        let request = Request {
            pipeline: "voxels".to_owned(),
            sets,
            parts: [("payload", "payload/bits".to_owned()), ("voxelize", format!("voxelize/{method}"))]
                .map(|(role, part)| (role.to_owned(), part))
                .into(),
            // The picture does not count.
            size: [1, 1],
            ..Request::default()
        };
        let prepared = prepare(&request, &self.library, Some(scene))?;
        let cutoff = prepared.graph.plan.knobs.iter().find_map(|knob| {
            match (knob.path.rsplit('.').next(), &knob.value) {
                (Some("cutoff"), Value::Number(area)) => Some(*area),
                _ => None,
            }
        });
        let mut frame = prepared.realise(&self.gpu, scene, self.clock.clone(), None)?;
        let begun = Instant::now();
        frame.run(&self.gpu, &Changes::All)?;
        let first_use = begun.elapsed();
        let slow = first_use > self.seconds;
        if !slow {
            frame.run(&self.gpu, &Changes::All)?;
        }
        let cell = Cell {
            method: method.to_owned(),
            cutoff,
            first_use_ms: 1e3 * first_use.as_secs_f64(),
            samples_ms: Vec::new(),
            stages_ms: BTreeMap::new(),
        };
        Ok(Subject { frame, cell, slow })
    }
}

impl Subject {
    fn sample(&mut self, gpu: &Gpu) -> Result<()> {
        let times = self.frame.run(gpu, &Changes::All)?.clone();
        let parts = parts(&self.frame, &times)?;
        self.cell.samples_ms.push(parts.iter().map(|(_, ms)| ms).sum());
        for (name, ms) in parts {
            self.cell.stages_ms.entry(name).or_default().push(ms);
        }
        Ok(())
    }
}

/// What counts of a frame: stages of [`ROLES`], and fills in sum.
fn parts(frame: &Frame, times: &Times) -> Result<Vec<(String, f64)>> {
    let mut parts = vec![(FILLS.to_owned(), record::fills(frame, times).unwrap_or(0.0))];
    for (step, ms) in frame.schedule.steps.iter().zip(&times.steps) {
        let Step::Run { task, .. } = step else { continue };
        let path = &frame.graph.stages[*task].path;
        if ROLES.iter().any(|role| path.starts_with(role)) {
            let unknown = || Problem::failure("no-time", format!("the time of `{path}` is not known"));
            parts.push((path.clone(), ms.ok_or_else(unknown)?));
        }
    }
    Ok(parts)
}

/// A bit for each voxel, as the payload `bits` keeps them: a summary comes first, a word for each 32.
fn filled(frame: &Frame, gpu: &Gpu, scene: &Scene) -> Result<Vec<u32>> {
    let mut names = vec!["filled"];
    if scene.still_triangles < scene.triangles.len() {
        names.push("moving_filled");
    }
    let mut voxels = Vec::new();
    for name in names {
        let resource = frame.graph.plan.resources.iter().position(|resource| resource.path == name);
        let missing = || Problem::failure("no-voxels", format!("the pipeline has no buffer `{name}`"));
        let bytes = frame.read_buffer(gpu, resource.ok_or_else(missing)?)?;
        let words: Vec<u32> = bytemuck::pod_collect_to_vec(&bytes);
        let words = &words[words.len() / 33..];
        voxels.resize(words.len(), 0);
        voxels.iter_mut().zip(words).for_each(|(all, word)| *all |= word);
    }
    Ok(voxels)
}
