//! Numbers as people read them: three significant digits, and a dash for what is not known.

/// For what is not known.
pub const UNKNOWN: &str = "–";

/// Three significant digits: `0.00123`, `12.3`, `1230`; from 10⁷ on and below 10⁻⁴ as `1.23e-5`.
pub fn number(value: f64) -> String {
    if !value.is_finite() {
        return UNKNOWN.to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    // The exponent after rounding: 9.996 is 10.0.
    let scientific = format!("{value:.2e}");
    let exponent = scientific.split_once('e').and_then(|(_, exponent)| exponent.parse::<i32>().ok());
    match exponent {
        Some(exponent @ -4..=6) => format!("{value:.*}", usize::try_from(2 - exponent).unwrap_or(0)),
        _ => scientific,
    }
}

pub fn maybe(value: Option<f64>) -> String {
    value.map_or_else(|| UNKNOWN.to_owned(), number)
}

/// A time in ms, with its unit.
pub fn milliseconds(value: Option<f64>) -> String {
    value.map_or_else(|| UNKNOWN.to_owned(), |ms| format!("{} ms", number(ms)))
}

/// With its sign: `+12.3`, `−0.004`.
pub fn signed(value: f64) -> String {
    match value {
        0.0 => "0".to_owned(),
        value if value < 0.0 => format!("−{}", number(-value)),
        value => format!("+{}", number(value)),
    }
}

/// A factor: `× 1.25`.
pub fn ratio(value: Option<f64>) -> String {
    value.map_or_else(|| UNKNOWN.to_owned(), |ratio| format!("× {}", number(ratio)))
}

pub fn bytes(count: u64) -> String {
    let mut value = count as f64;
    let mut unit = "B";
    for larger in ["KiB", "MiB", "GiB", "TiB"] {
        if value < 1024.0 {
            break;
        }
        value /= 1024.0;
        unit = larger;
    }
    if unit == "B" { format!("{count} B") } else { format!("{value:.1} {unit}") }
}

/// With thin spaces between thousands.
pub fn count(count: u64) -> String {
    let digits = count.to_string();
    let mut text = String::new();
    for (at, digit) in digits.chars().enumerate() {
        if at > 0 && (digits.len() - at).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

/// `one`, or `many` with the number before it.
pub fn plural(count: usize, one: &str, many: &str) -> String {
    if count == 1 { format!("1 {one}") } else { format!("{count} {many}") }
}
