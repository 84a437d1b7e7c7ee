//! Problems as people read them (drawn by miette) and as programs read them (JSON).

use super::{Kind, Place, Problem, Problems};
use miette::{
    Diagnostic, GraphicalReportHandler, GraphicalTheme, LabeledSpan, NamedSource, Severity, SourceCode,
};
use std::fmt;

/// The labels of one problem that lie in one source; further sources hang below as related reports.
struct Report {
    problem: Problem,
    head: bool,
    source: Option<NamedSource<String>>,
    labels: Vec<LabeledSpan>,
    related: Vec<Report>,
}

impl Report {
    fn new(problem: &Problem) -> Self {
        let mut by_source: Vec<(&Place, Vec<LabeledSpan>)> = Vec::new();
        for (place, text) in &problem.labels {
            let label = LabeledSpan::new(
                (!text.is_empty()).then(|| text.clone()),
                place.span.start,
                place.span.len(),
            );
            match by_source.iter_mut().find(|(first, _)| first.source == place.source) {
                Some((_, labels)) => labels.push(label),
                None => by_source.push((place, vec![label])),
            }
        }
        let mut reports = by_source.into_iter().enumerate().map(|(i, (place, labels))| Report {
            problem: problem.clone(),
            head: i == 0,
            source: Some(NamedSource::new(place.source.name(), place.source.text().to_owned())),
            labels,
            related: Vec::new(),
        });
        let mut head = reports.next().unwrap_or(Report {
            problem: problem.clone(),
            head: true,
            source: None,
            labels: Vec::new(),
            related: Vec::new(),
        });
        head.related = reports.collect();
        head
    }
}

impl fmt::Debug for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.head { &self.problem.message } else { "the other place" })
    }
}

impl std::error::Error for Report {}

impl Diagnostic for Report {
    fn code<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.head.then(|| Box::new(self.problem.code) as _)
    }

    fn severity(&self) -> Option<Severity> {
        Some(match self.problem.kind {
            _ if !self.head => Severity::Advice,
            Kind::Warning => Severity::Warning,
            Kind::Input | Kind::Failure => Severity::Error,
        })
    }

    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.problem.help.as_ref().filter(|_| self.head).map(|h| Box::new(h) as _)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.source.as_ref().map(|s| s as _)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        Some(Box::new(self.labels.iter().cloned()))
    }

    fn related<'a>(&'a self) -> Option<Box<dyn Iterator<Item = &'a dyn Diagnostic> + 'a>> {
        Some(Box::new(self.related.iter().map(|r| r as _)))
    }
}

/// Longest line of a source that is drawn, in bytes. miette panics from column 65,536 on, and nobody reads that far.
const LONGEST_LINE: usize = 2000;

impl Problem {
    /// The problem with places in sources of very long lines named in its message instead of drawn.
    fn drawable(&self) -> Self {
        let is_drawable = |place: &Place| place.source.text().lines().all(|line| line.len() <= LONGEST_LINE);
        let mut problem = self.clone();
        problem.labels.retain(|(place, _)| is_drawable(place));
        for (place, text) in self.labels.iter().filter(|(place, _)| !is_drawable(place)) {
            problem.message += &format!(" ({place:?}: {text})");
        }
        problem
    }

    /// The message with its pieces of source, as a terminal shows it. `color`: with ANSI colours and box drawing.
    pub fn render(&self, color: bool) -> String {
        let theme = if color { GraphicalTheme::unicode() } else { GraphicalTheme::unicode_nocolor() };
        let handler = GraphicalReportHandler::new_themed(theme).with_width(110).with_links(false);
        let mut text = String::new();
        match handler.render_report(&mut text, &Report::new(&self.drawable())) {
            Ok(()) => text,
            Err(_) => format!("{}: {}", self.code, self.message),
        }
    }

    pub fn to_json(&self) -> serde_json::Value {
        let places: Vec<_> = self
            .labels
            .iter()
            .map(|(place, text)| {
                let (line, column) = place.line_column();
                serde_json::json!({"file": place.source.name(), "line": line, "column": column, "text": text})
            })
            .collect();
        serde_json::json!({
            "kind": match self.kind {
                Kind::Warning => "warning",
                Kind::Input => "input",
                Kind::Failure => "failure",
            },
            "code": self.code, "message": self.message, "places": places, "help": self.help,
        })
    }
}

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.iter().try_for_each(|p| f.write_str(&p.render(false)))
    }
}

impl std::error::Error for Problems {}
