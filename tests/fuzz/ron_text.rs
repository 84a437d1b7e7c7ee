//! Mutants of RON texts: pieces of text moved, doubled, dropped or taken from other texts, so that brackets mostly match.

use fastrand::Rng;
use std::ops::Range;

/// Texts, and all their words, to take pieces from.
pub struct Corpus {
    pub texts: Vec<String>,
    words: Vec<String>,
}

const NUMBERS: [&str; 16] = [
    "0",
    "1",
    "-1",
    "2",
    "3.5",
    "1e-30",
    "1e30",
    "1e400",
    "-0.0",
    "NaN",
    "inf",
    "4294967296",
    "-9223372036854775808",
    "18446744073709551616",
    "0x7fffffff",
    "65537",
];

impl Corpus {
    pub fn new(texts: Vec<String>) -> Self {
        let mut words: Vec<String> =
            texts.iter().flat_map(|text| pieces(text).into_iter().map(|at| text[at].to_owned())).collect();
        words.sort_unstable();
        words.dedup();
        Self { texts, words }
    }

    /// `text` with one to four changes.
    pub fn mutant(&self, text: &str, dice: &mut Rng) -> String {
        let mut text = text.to_owned();
        for _ in 0..1 + dice.usize(..4) * dice.usize(..2) {
            self.change(&mut text, dice);
            if text.len() > 1 << 18 {
                break;
            }
        }
        text
    }

    fn change(&self, text: &mut String, dice: &mut Rng) {
        let pieces = pieces(text);
        let Some(piece) = dice.choice(&pieces).cloned() else { return };
        match dice.usize(..12) {
            0 => text.replace_range(piece, ""),
            1 => {
                let copy = text[piece.clone()].to_owned();
                text.insert_str(piece.end, &copy);
            }
            2 | 3 => self.replace_alike(text, piece, dice),
            4 => text.replace_range(piece, NUMBERS[dice.usize(..NUMBERS.len())]),
            5 => {
                let word = dice.choice(&self.words).cloned().unwrap_or_default();
                text.replace_range(piece, &word);
            }
            6 => {
                let other = dice.choice(&pieces).cloned().unwrap_or_default();
                let (first, second) = if piece.start < other.start { (piece, other) } else { (other, piece) };
                if first.end <= second.start {
                    let (a, b) = (text[first.clone()].to_owned(), text[second.clone()].to_owned());
                    text.replace_range(second, &a);
                    text.replace_range(first, &b);
                }
            }
            7 | 8 => {
                let groups = groups(text);
                let Some(group) = dice.choice(&groups).cloned() else { return };
                let donor = &self.texts[dice.usize(..self.texts.len())];
                let others: Vec<_> = self::groups(donor)
                    .into_iter()
                    .filter(|o| donor.as_bytes()[o.start] == text.as_bytes()[group.start])
                    .collect();
                if let Some(other) = dice.choice(&others) {
                    text.replace_range(group, &donor[other.clone()]);
                }
            }
            9 => {
                let groups = groups(text);
                let Some(group) = dice.choice(&groups).cloned() else { return };
                let copy = text[group.clone()].to_owned();
                match dice.usize(..3) {
                    0 => text.replace_range(group, ""),
                    1 => text.insert_str(group.end, &format!(", {copy}")),
                    _ => {
                        let times = if dice.usize(..20) == 0 { 100_000 } else { dice.usize(1..300) };
                        text.replace_range(group, &copy[..1].repeat(times));
                    }
                }
            }
            10 => {
                let entries = lines(text);
                let Some(line) = dice.choice(&entries).cloned() else { return };
                let copy = text[line.clone()].to_owned();
                let at =
                    if dice.bool() { line.end } else { dice.choice(&entries).map_or(0, |line| line.start) };
                text.insert_str(at, &copy.repeat(if dice.usize(..20) == 0 { dice.usize(1..200) } else { 1 }));
            }
            _ => {
                let strange = ["\u{0}", "é", "\u{202e}", "\\", "\"", "r#\"", "/*", "//", "\n", "(", "]", "§"];
                text.insert_str(piece.start, strange[dice.usize(..strange.len())]);
            }
        }
    }

    /// A word for a word, a number for a number, a sign for a sign.
    fn replace_alike(&self, text: &mut String, piece: Range<usize>, dice: &mut Rng) {
        let class = |text: &str| match text.chars().next() {
            Some(c) if c.is_ascii_digit() => 0,
            Some(c) if c.is_alphabetic() => 1,
            _ => 2,
        };
        let wanted = class(&text[piece.clone()]);
        for _ in 0..50 {
            let word = dice.choice(&self.words).cloned().unwrap_or_default();
            if class(&word) == wanted {
                return text.replace_range(piece, &word);
            }
        }
    }
}

/// Words, numbers and single signs; no white space.
fn pieces(text: &str) -> Vec<Range<usize>> {
    let mut list: Vec<Range<usize>> = Vec::new();
    for (at, c) in text.char_indices().filter(|(_, c)| !c.is_whitespace()) {
        let wordy = c.is_alphanumeric() || c == '_';
        let end = at + c.len_utf8();
        match list.last_mut() {
            Some(last)
                if wordy
                    && last.end == at
                    && text[last.clone()].ends_with(|c: char| c.is_alphanumeric() || c == '_') =>
            {
                last.end = end;
            }
            _ => list.push(at..end),
        }
    }
    list
}

/// What stands between brackets that match, with them.
fn groups(text: &str) -> Vec<Range<usize>> {
    let (mut open, mut list) = (Vec::new(), Vec::new());
    for (at, c) in text.bytes().enumerate() {
        match c {
            b'(' | b'[' | b'{' => open.push(at),
            b')' | b']' | b'}' => list.extend(open.pop().map(|start| start..at + 1)),
            _ => {}
        }
    }
    list
}

fn lines(text: &str) -> Vec<Range<usize>> {
    let mut at = 0;
    text.split_inclusive('\n')
        .map(|line| {
            at += line.len();
            at - line.len()..at
        })
        .collect()
}
