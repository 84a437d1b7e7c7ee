//! The sRGB transfer function, IEC 61966-2-1, on numbers from 0 to 1.

/// Linear light of a coded value.
pub fn decode(coded: f32) -> f32 {
    if coded <= 0.040_45 { coded / 12.92 } else { ((coded + 0.055) / 1.055).powf(2.4) }
}

/// Coded value of linear light.
pub fn encode(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// Coded value in 8 bits, rounded to nearest; beyond 0 and 1 it is clipped, NaN becomes 0.
pub fn encode8(linear: f32) -> u8 {
    (encode(linear.clamp(0.0, 1.0)) * 255.0).round() as u8
}
