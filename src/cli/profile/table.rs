//! A profile as text for people.
//!
//! Where there is room, a stage is one line; on narrow terminals times and bytes are two tables.

use super::rows::{self, Row};
use crate::cli::run::heading;
use crate::profile::Profile;
use crate::profile::copy::CopySpeed;
use crate::record::StageRecord;
use crate::session::bytes;
use comfy_table::{Cell, CellAlignment, ColumnConstraint, ContentArrangement, Table, Width};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Columns of text on standard output: of the terminal, or enough for one line a stage if it is none.
pub fn width() -> usize {
    terminal_size::terminal_size_of(std::io::stdout()).map_or(120, |(width, _)| usize::from(width.0))
}

/// The narrowest width at which times and bytes are one table, beside the names.
const BOTH: usize = 84;

type Column = (&'static str, fn(&Row) -> String);

const TIMES: [Column; 4] = [
    ("median", |row| ms(row.median)),
    ("p10 – p90", |row| match (row.spread.p10, row.spread.p90) {
        (Some(low), Some(high)) => format!("{} – {}", ms(Some(low)), ms(Some(high))),
        _ => "–".to_owned(),
    }),
    ("share", |row| percent(row.share, 1)),
    ("first use", |row| ms(row.first_use)),
];
const BYTES: [Column; 4] = [
    ("read", |row| row.bytes.map_or_else(|| "?".to_owned(), |b| size(b.read_bytes))),
    ("written", |row| row.bytes.map_or_else(|| "?".to_owned(), |b| size(b.written_bytes))),
    ("GB/s", |row| row.gb_per_s.map_or_else(|| "–".to_owned(), |speed| format!("{speed:.2}"))),
    ("of copy", |row| percent(row.of_copy, 0)),
];

pub fn text(profile: &Profile, width: usize) -> String {
    let stages = rows::rows(profile);
    let totals = [rows::fills(profile), rows::frame(profile)];
    let names = stages.iter().chain(&totals).map(|row| row.name.chars().count()).max().unwrap_or(0);
    let mut text = String::new();
    let mut say = |part: &str| {
        text.push_str(part);
        text.push('\n');
    };
    say(&wrapped(&heading(&profile.record, &course(profile)), width));
    say("");
    say(&wrapped(
        "Times in ms. Bytes are what a stage binds, each counted once: what it has to move at least, if it touches \
         all of that. GB/s is read and written together.",
        width,
    ));
    say("");
    let lists: Vec<Vec<Column>> = match names + BOTH <= width {
        true => vec![TIMES.into_iter().chain(BYTES).collect()],
        false => vec![TIMES.to_vec(), BYTES.to_vec()],
    };
    for columns in &lists {
        say(&table(&stages, &totals, columns, width));
        say("");
    }
    say(&format!("encode and submit (CPU): {} ms", ms(profile.record.encode_ms)));
    say(&format!(
        "copy speed: {}, {}",
        copy("buffer", &profile.copy.buffer),
        copy("texture", &profile.copy.texture)
    ));
    for (counter, count) in &profile.record.counters {
        say(&format!("{counter}: {count}"));
    }
    for status in ["kept", "dropped"] {
        let reasons = reasons(&profile.record.stages, status);
        if !reasons.is_empty() {
            say(&format!("\n{status}, since"));
        }
        for (reason, paths) in reasons {
            say(&indented(&format!("{reason}: {}", paths.join(", ")), width));
        }
    }
    for lack in &profile.record.lacks {
        say(&wrapped(&format!("left out: {lack}"), width));
    }
    text
}

/// Which frames the times are of.
fn course(profile: &Profile) -> String {
    let frames = profile.record.frames;
    let mut text = format!(
        "{frames} frame{} after 1 + {} to warm up",
        if frames == 1 { "" } else { "s" },
        profile.warm_up
    );
    if let Some(moves) = &profile.camera_moves {
        let _infallible = write!(text, "; the camera moves {moves}");
    }
    match &profile.changes {
        Some(changes) if changes.is_empty() => text += "; nothing changes",
        Some(changes) => {
            let _infallible = write!(text, "; changing: {}", changes.join(", "));
        }
        None => {}
    }
    text
}

fn table(stages: &[Row], totals: &[Row], columns: &[Column], width: usize) -> String {
    let mut table = Table::new();
    table.load_style(comfy_table::presets::NOTHING).set_content_arrangement(ContentArrangement::Dynamic);
    table.set_width(u16::try_from(width).unwrap_or(u16::MAX));
    let right = |text: String| Cell::new(text).set_alignment(CellAlignment::Right);
    table
        .set_header(std::iter::once(Cell::new("stage")).chain(columns.iter().map(|c| right(c.0.to_owned()))));
    let line = |row: &Row| {
        let cells: Vec<Cell> = columns.iter().map(|column| right(column.1(row))).collect();
        std::iter::once(Cell::new(&row.name)).chain(cells).collect::<Vec<_>>()
    };
    stages.iter().for_each(|row| {
        table.add_row(line(row));
    });
    table.add_row(vec![Cell::new("")]);
    totals.iter().for_each(|row| {
        table.add_row(line(row));
    });
    for (index, column) in table.column_iter_mut().enumerate() {
        column.set_padding((if index == 0 { 0 } else { 1 }, 1));
        if index > 0 {
            column.set_constraint(ColumnConstraint::ContentWidth);
        } else {
            column.set_constraint(ColumnConstraint::LowerBoundary(Width::Fixed(12)));
        }
    }
    let lines: Vec<String> = table.lines().map(|line| line.trim_end().to_owned()).collect();
    lines.join("\n")
}

/// The stages with this status, by reason.
fn reasons<'p>(stages: &'p [StageRecord], status: &str) -> BTreeMap<&'p str, Vec<&'p str>> {
    let mut by_reason: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for stage in stages.iter().filter(|stage| stage.status == status) {
        by_reason.entry(stage.reason.as_deref().unwrap_or_default()).or_default().push(&stage.path);
    }
    by_reason
}

fn copy(what: &str, speed: &CopySpeed) -> String {
    let rate = speed.gb_per_s.map_or_else(|| "unknown".to_owned(), |speed| format!("{speed:.2} GB/s"));
    format!("{what} {rate} ({})", bytes(speed.bytes))
}

/// Four digits, or three places.
fn ms(time: Option<f64>) -> String {
    match time {
        None => "–".to_owned(),
        Some(time) if time >= 1000.0 => format!("{time:.0}"),
        Some(time) if time >= 100.0 => format!("{time:.1}"),
        Some(time) if time >= 10.0 => format!("{time:.2}"),
        Some(time) => format!("{time:.3}"),
    }
}

fn percent(ratio: Option<f64>, places: usize) -> String {
    ratio.map_or_else(|| "–".to_owned(), |ratio| format!("{:.places$} %", 100.0 * ratio))
}

fn size(n: u64) -> String {
    if n == 0 { "–".to_owned() } else { bytes(n) }
}

/// Lines of at most `width` characters, broken at spaces.
fn wrapped(text: &str, width: usize) -> String {
    broken(text, width, "")
}

/// Likewise, two spaces in, and four where a line goes on.
fn indented(text: &str, width: usize) -> String {
    format!("  {}", broken(text, width.saturating_sub(4), "    "))
}

fn broken(text: &str, width: usize, indent: &str) -> String {
    let mut lines: Vec<String> = Vec::new();
    for given in text.lines() {
        let mut line = String::new();
        for word in given.split(' ') {
            if !line.is_empty() && line.chars().count() + 1 + word.chars().count() > width {
                lines.push(std::mem::take(&mut line));
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
        lines.push(line);
    }
    lines.join(&format!("\n{indent}"))
}
