//! `--scan`: runs the stages one by one and looks for NaN and infinities in what each wrote.

use super::{Frame, Op};
use crate::device::Gpu;
use crate::graph::{Shape, Usage};
use crate::kernel::{BindingKind, FieldKind, Scalar};
use crate::plan::Reference;
use crate::problem::Problem;

/// Numbers that are none, in what one stage wrote.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Finding {
    pub stage: String,
    pub resource: String,
    pub nan: usize,
    pub infinite: usize,
    /// Texel (or word of a buffer) of the first.
    pub first: usize,
}

impl Frame {
    /// Runs a frame and reports, in the order of the stages, what was written that is not finite; the first finding
    /// is the source.
    pub fn scan(&mut self, gpu: &Gpu) -> Result<Vec<Finding>, Problem> {
        self.reset();
        self.begin_steps(gpu);
        let mut findings = Vec::new();
        for step in 0..self.ops.len() {
            self.submit_step(gpu, step);
            gpu.wait()?;
            if let Op::Stage(task) = self.ops[step] {
                self.look(gpu, task, &mut findings)?;
            }
        }
        self.end_steps();
        Ok(findings)
    }

    fn look(&self, gpu: &Gpu, task: usize, findings: &mut Vec<Finding>) -> Result<(), Problem> {
        let stage = &self.graph.stages[task];
        let Some(linked) = &stage.linked else { return Ok(()) };
        for touch in linked.touches.iter().filter(|t| t.write) {
            let resource = &self.graph.resources[touch.reference.resource];
            match &resource.shape {
                Shape::Texture(_) => {
                    for cell in self.graph.cells(&touch.reference) {
                        let (mip, layer) = (cell % resource.mips, (cell / resource.mips) % resource.layers);
                        let one = Reference { mip: Some(mip), layer: Some(layer), ..touch.reference };
                        let image = self.read(gpu, &one)?;
                        if image.float {
                            let texels = image.data.iter().enumerate().map(|(i, x)| (i / image.channels, *x));
                            note(&stage.path, &self.graph.name(&one), texels, findings);
                        }
                    }
                }
                Shape::Buffer(_) if touch.how == Usage::StorageBuffer => {
                    let binding = linked.reflected.bindings.iter().find(|b| b.name == touch.binding);
                    let Some(BindingKind::Storage(layout)) = binding.map(|b| &b.kind) else { continue };
                    let Some(element) = &layout.element else { continue };
                    let bytes = self.read_buffer(gpu, touch.reference.resource)?;
                    let stride = layout.stride.unwrap_or(layout.head).max(1) as usize;
                    let head = if layout.stride.is_some() { layout.head as usize } else { 0 };
                    let elements = bytes.get(head..).unwrap_or(&[]).chunks_exact(stride).enumerate();
                    let floats = elements.flat_map(|(i, element_bytes)| {
                        element.fields.iter().flat_map(move |field| {
                            let words = match field.kind {
                                FieldKind::Vector { components, scalar: Scalar::F32 } => {
                                    usize::from(components)
                                }
                                _ => 0,
                            };
                            let at = field.offset as usize;
                            let piece = element_bytes.get(at..at + 4 * words).unwrap_or(&[]);
                            piece
                                .chunks_exact(4)
                                .map(move |w| (i, f32::from_le_bytes([w[0], w[1], w[2], w[3]])))
                        })
                    });
                    note(&stage.path, &self.graph.name(&touch.reference), floats, findings);
                }
                _ => {}
            }
        }
        Ok(())
    }
}

fn note(
    stage: &str,
    resource: &str,
    numbers: impl Iterator<Item = (usize, f32)>,
    findings: &mut Vec<Finding>,
) {
    let mut finding = Finding {
        stage: stage.to_owned(),
        resource: resource.to_owned(),
        nan: 0,
        infinite: 0,
        first: usize::MAX,
    };
    for (at, number) in numbers {
        if !number.is_finite() {
            finding.first = finding.first.min(at);
            if number.is_nan() {
                finding.nan += 1;
            } else {
                finding.infinite += 1;
            }
        }
    }
    if finding.nan + finding.infinite > 0 {
        findings.push(finding);
    }
}
