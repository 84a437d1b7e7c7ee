//! WGSL as the composer sees it: words, numbers, single signs and matched brackets. Comments and white space are gone.
//!
//! Only what is needed to tell where a declaration, a statement or a member begins and ends; everything else about
//! WGSL is naga's to judge. `<` and `>` are plain signs here, since telling them from comparisons needs the grammar.

use crate::problem::{Place, Problem, Source};
use std::ops::Range;

/// How deep brackets may nest, for what follows them by recursion: this module's users, and naga.
const DEEPEST: usize = 120;
/// How many tokens may follow each other without a `,` or `;`, counted through all brackets that are open: a chain of
/// operators, members or `else if` is recursion as well, and naga has no limit of its own there.
const LONGEST: usize = 1000;
/// What ends a `//` comment.
const LINE_ENDS: [char; 7] = ['\n', '\u{b}', '\u{c}', '\r', '\u{85}', '\u{2028}', '\u{2029}'];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Word,
    Number,
    /// A quoted text inside a condition; WGSL itself has none.
    Text,
    Sign(char),
}

#[derive(Clone, Copy, Debug)]
pub struct Token {
    pub kind: Kind,
    pub start: usize,
    pub end: usize,
    /// The index of the other bracket of the pair; for all other tokens its own.
    pub partner: usize,
}

/// The tokens of one file.
pub struct Tokens {
    pub source: Source,
    list: Vec<Token>,
}

impl Tokens {
    /// Reads a file. An error is a comment that does not end or a bracket without its partner.
    pub fn read(source: &Source) -> Result<Self, Problem> {
        let mut list = Vec::new();
        let mut at = 0;
        while let Some((kind, span)) = next(source, at)? {
            at = span.end;
            list.push(Token { kind, start: span.start, end: span.end, partner: list.len() });
        }
        match_brackets(source, &mut list)?;
        Ok(Self { source: source.clone(), list })
    }

    pub fn len(&self) -> usize {
        self.list.len()
    }

    pub fn get(&self, i: usize) -> Option<Token> {
        self.list.get(i).copied()
    }

    /// The word at `i`, or `""` if there is none.
    pub fn word(&self, i: usize) -> &str {
        match self.get(i) {
            Some(Token { kind: Kind::Word, start, end, .. }) => &self.source.text()[start..end],
            _ => "",
        }
    }

    pub fn is_sign(&self, i: usize, sign: char) -> bool {
        self.get(i).is_some_and(|token| token.kind == Kind::Sign(sign))
    }

    /// The token after `i`, or after the bracket that closes if one opens at `i`.
    pub fn after(&self, i: usize) -> usize {
        self.get(i).map_or(i, |token| token.partner.max(i)) + 1
    }

    /// The first `sign` in `range` that is in no bracket opened within it.
    pub fn find(&self, range: Range<usize>, sign: char) -> Option<usize> {
        let mut i = range.start;
        while i < range.end {
            if self.is_sign(i, sign) {
                return Some(i);
            }
            i = self.after(i);
        }
        None
    }

    /// The bytes from the first to the last token of a range of tokens.
    pub fn bytes(&self, range: Range<usize>) -> Range<usize> {
        let start = self.get(range.start).map_or(self.source.text().len(), |token| token.start);
        let end = range.end.checked_sub(1).and_then(|last| self.get(last)).map_or(start, |token| token.end);
        start..end.max(start)
    }

    pub fn place(&self, range: Range<usize>) -> Place {
        self.source.at(self.bytes(range))
    }
}

/// The next token at or after the byte `at`.
fn next(source: &Source, mut at: usize) -> Result<Option<(Kind, Range<usize>)>, Problem> {
    let text = source.text();
    loop {
        let rest = &text[at..];
        let Some(first) = rest.chars().next() else { return Ok(None) };
        if first.is_whitespace() {
            at += first.len_utf8();
        } else if rest.starts_with("//") {
            at += rest.find(LINE_ENDS).unwrap_or(rest.len());
        } else if rest.starts_with("/*") {
            at += block_comment(rest).ok_or_else(|| {
                Problem::input("open-comment", "a comment does not end")
                    .at(&source.at(at..at + 2), "it begins here")
                    .help("each `/*` needs its own `*/`, also inside another comment")
            })?;
        } else {
            let word = |c: char| c.is_alphanumeric() || c == '_';
            let until = |end: fn(char) -> bool| rest.find(end).unwrap_or(rest.len());
            let (kind, length) = match first {
                '0'..='9' => (Kind::Number, until(|c| !(c.is_alphanumeric() || c == '_' || c == '.'))),
                c if word(c) => (Kind::Word, until(|c| !(c.is_alphanumeric() || c == '_'))),
                '"' | '\'' => match rest[1..].find([first, '\n']) {
                    Some(end) if rest[1 + end..].starts_with(first) => (Kind::Text, end + 2),
                    _ => (Kind::Sign(first), 1),
                },
                c => (Kind::Sign(c), c.len_utf8()),
            };
            return Ok(Some((kind, at..at + length)));
        }
    }
}

/// The length of the block comment, with those nested in it, at the start of `text`.
fn block_comment(text: &str) -> Option<usize> {
    let mut depth = 0_usize;
    let mut at = 0;
    while let Some(found) = text[at..].find(['/', '*']) {
        at += found;
        if text[at..].starts_with("/*") {
            depth += 1;
            at += 2;
        } else if text[at..].starts_with("*/") {
            depth -= 1;
            at += 2;
            if depth == 0 {
                return Some(at);
            }
        } else {
            at += 1;
        }
    }
    None
}

/// A bracket that is not closed yet.
struct Open {
    token: usize,
    /// The length of the run of tokens at it.
    run: usize,
}

/// Pairs the brackets, and sees to it that nothing is too deep.
fn match_brackets(source: &Source, list: &mut [Token]) -> Result<(), Problem> {
    let mut open: Vec<Open> = Vec::new();
    let mut run = 0;
    let wrong = |token: Token, message: String| {
        Problem::input("bracket", message).at(&source.at(token.start..token.end), "this one")
    };
    for i in 0..list.len() {
        run += 1;
        if run > LONGEST {
            let message = format!("more than {LONGEST} words and signs without a `,` or `;`");
            return Err(Problem::input("too-long", message)
                .at(&source.at(list[i].start..list[i].end), "it goes on from here")
                .help("split the expression: `let` gives a name to a part of it"));
        }
        let Kind::Sign(sign) = list[i].kind else { continue };
        let opening = match sign {
            '(' | '[' | '{' if open.len() >= DEEPEST => {
                return Err(wrong(list[i], format!("brackets are nested more than {DEEPEST} deep")));
            }
            '(' | '[' | '{' => {
                open.push(Open { token: i, run });
                continue;
            }
            ',' | ';' => {
                run = open.last().map_or(0, |open| open.run);
                continue;
            }
            ')' => '(',
            ']' => '[',
            '}' => '{',
            _ => continue,
        };
        match open.pop() {
            Some(Open { token: j, run: before }) if list[j].kind == Kind::Sign(opening) => {
                list[j].partner = i;
                list[i].partner = j;
                let goes_on = sign != '}'
                    || list.get(i + 1).is_some_and(|next| source.text()[next.start..].starts_with("else"));
                run = if goes_on { before } else { open.last().map_or(0, |open| open.run) };
            }
            Some(Open { token: j, .. }) => {
                let before = source.at(list[j].start..list[j].end);
                let problem = wrong(list[i], format!("`{sign}` closes no `{opening}`"));
                return Err(problem.at(&before, "this one is still open"));
            }
            None => return Err(wrong(list[i], format!("`{sign}` closes no `{opening}`"))),
        }
    }
    match open.pop() {
        Some(Open { token: j, .. }) => {
            let sign = &source.text()[list[j].start..list[j].end];
            Err(wrong(list[j], format!("this `{sign}` is never closed")))
        }
        None => Ok(()),
    }
}
