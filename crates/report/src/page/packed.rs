//! Arrays of numbers as base64 of little-endian bytes: four characters for three bytes, far shorter than decimal text.

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
pub(super) fn floats(values: impl IntoIterator<Item = f64>) -> String {
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
    fn numbers_are_little_endian() {
        assert_eq!(floats([1.0]), base64(&[0, 0, 0x80, 0x3f]));
        assert_eq!(shorts([0x0102]), base64(&[2, 1]));
        assert_eq!(words([0x0102_0304]), base64(&[4, 3, 2, 1]));
    }
}
