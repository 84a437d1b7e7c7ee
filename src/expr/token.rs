//! The words of an expression.

use crate::problem::{Place, Problem};
use std::ops::Range;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Token<'a> {
    Number(f64),
    Text(&'a str),
    /// Dotted, as written.
    Name(&'a str),
    Symbol(&'static str),
    End,
}

/// Longer ones before their beginnings.
const SYMBOLS: [&str; 18] =
    ["&&", "||", "==", "!=", "<=", ">=", "<", ">", "!", "+", "-", "*", "/", "%", "(", ")", ",", "."];

/// The tokens of `place`'s text with their bytes in its source, then one [`Token::End`].
pub(super) fn tokens(place: &Place) -> Result<Vec<(Token<'_>, Range<usize>)>, Problem> {
    let text = place.text();
    let mut found = Vec::new();
    let mut at = 0;
    loop {
        at += text[at..].len() - text[at..].trim_start().len();
        let rest = &text[at..];
        let Some(first) = rest.chars().next() else { break };
        let span = |length: usize| place.span.start + at..place.span.start + at + length;
        let (token, length) = if first.is_ascii_digit() {
            let length = number_length(rest);
            let number = number(&rest[..length]).ok_or_else(|| {
                Problem::input("expression-syntax", format!("`{}` is not a number", &rest[..length]))
                    .at(&place.source.at(span(length)), "here")
            })?;
            (Token::Number(number), length)
        } else if first.is_ascii_alphabetic() || first == '_' {
            let length = name_length(rest);
            (Token::Name(&rest[..length]), length)
        } else if first == '"' || first == '\'' {
            let Some(length) = rest[1..].find(first) else {
                return Err(Problem::input("expression-syntax", "this text has no closing quote")
                    .at(&place.source.at(span(rest.len())), "begins here"));
            };
            (Token::Text(&rest[1..=length]), length + 2)
        } else if let Some(symbol) = SYMBOLS.iter().find(|symbol| rest.starts_with(**symbol)) {
            (Token::Symbol(symbol), symbol.len())
        } else {
            let problem =
                Problem::input("expression-syntax", format!("`{first}` means nothing in an expression"))
                    .at(&place.source.at(span(first.len_utf8())), "here");
            return Err(match first {
                '=' => problem.help("to compare, write `==`"),
                '&' => problem.help("for “and”, write `&&`"),
                '|' => problem.help("for “or”, write `||`"),
                '\\' => problem.help("texts inside of expressions can be written 'so', without escapes"),
                _ => problem,
            });
        };
        found.push((token, span(length)));
        at += length;
    }
    found.push((Token::End, place.span.end..place.span.end));
    Ok(found)
}

fn name_length(text: &str) -> usize {
    let piece =
        |text: &str| text.bytes().take_while(|byte| byte.is_ascii_alphanumeric() || *byte == b'_').count();
    let mut length = piece(text);
    while let Some(after) = text[length..].strip_prefix('.') {
        if !after.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_') {
            break;
        }
        length += 1 + piece(after);
    }
    length
}

/// As far as letters, digits and points go, with the sign of an exponent.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let decimal = !text.starts_with("0x");
    (0..bytes.len())
        .find(|&i| {
            let exponent_sign =
                decimal && matches!(bytes[i], b'+' | b'-') && matches!(bytes[i - 1], b'e' | b'E');
            !(bytes[i].is_ascii_alphanumeric() || matches!(bytes[i], b'.' | b'_') || exponent_sign)
        })
        .unwrap_or(bytes.len())
}

fn number(text: &str) -> Option<f64> {
    let plain = text.replace('_', "");
    let number = match plain.strip_prefix("0x") {
        Some(digits) => u32::from_str_radix(digits, 16).ok()?.into(),
        None => plain.parse::<f64>().ok()?,
    };
    number.is_finite().then_some(number)
}
