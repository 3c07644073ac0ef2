//! Arrays of numbers as base64 of little-endian bytes: four characters for three bytes, far shorter than decimal text.

use serde_json::{Value, json};

const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Base64 (RFC 4648, with padding).
pub(super) fn base64(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let word = chunk.iter().enumerate().fold(0u32, |word, (i, byte)| {
            word | u32::from(*byte) << (16 - 8 * i)
        });
        for i in 0..4 {
            if i <= chunk.len() {
                text.push(char::from(ALPHABET[(word >> (18 - 6 * i)) as usize & 63]));
            } else {
                text.push('=');
            }
        }
    }
    text
}

/// 32-bit floats: seven digits are more than a picture shows.
pub(crate) fn floats(values: impl IntoIterator<Item = f64>) -> String {
    base64(
        &values
            .into_iter()
            .flat_map(|v| (v as f32).to_le_bytes())
            .collect::<Vec<u8>>(),
    )
}

/// 16-bit unsigned integers.
pub(super) fn shorts(values: impl IntoIterator<Item = u16>) -> String {
    base64(
        &values
            .into_iter()
            .flat_map(u16::to_le_bytes)
            .collect::<Vec<u8>>(),
    )
}

/// Values from 0 on as 16-bit multiples of a step: `{step, values}`. Zero stays zero.
pub(crate) fn scaled(values: impl Iterator<Item = f64>) -> Value {
    let values: Vec<f64> = values.collect();
    let most = values.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let step = most / f64::from(u16::MAX);
    let packed = shorts(values.iter().map(|value| (value / step).round() as u16));
    json!({"step": step, "values": packed})
}

/// Values of both signs as 16-bit multiples of a step: `{step, values}`.
pub(crate) fn scaled_signed(values: impl Iterator<Item = f64>) -> Value {
    let values: Vec<f64> = values.collect();
    let most = values
        .iter()
        .fold(f64::MIN_POSITIVE, |most, value| most.max(value.abs()));
    let step = most / f64::from(i16::MAX);
    let packed = shorts(
        values
            .iter()
            .map(|value| (value / step).round() as i16 as u16),
    );
    json!({"step": step, "values": packed})
}

/// 32-bit unsigned integers.
pub(super) fn words(values: impl IntoIterator<Item = u32>) -> String {
    base64(
        &values
            .into_iter()
            .flat_map(u32::to_le_bytes)
            .collect::<Vec<u8>>(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_of_rfc_4648() {
        // Section 10 of the RFC.
        for (plain, coded) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(plain.as_bytes()), coded);
        }
    }

    #[test]
    fn scaled_values_keep_zero_and_their_largest() {
        let packed = scaled([0.0, 655.35].into_iter());
        assert_eq!(packed["values"], shorts([0, u16::MAX]));
        assert!((packed["step"].as_f64().unwrap_or(0.0) - 0.01).abs() < 1e-12);
        let signed = scaled_signed([-2.0, 1.0].into_iter());
        assert_eq!(signed["values"], shorts([(-i16::MAX) as u16, 16384]));
        // Nothing at all has a step, too.
        assert_eq!(scaled([0.0].into_iter())["values"], shorts([0]));
    }

    #[test]
    fn numbers_are_little_endian() {
        assert_eq!(floats([1.0]), base64(&[0, 0, 0x80, 0x3f]));
        assert_eq!(shorts([0x0102]), base64(&[2, 1]));
        assert_eq!(words([0x0102_0304]), base64(&[4, 3, 2, 1]));
    }
}
