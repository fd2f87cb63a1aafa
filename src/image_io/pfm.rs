//! PFM files: a text header of `PF` (colour) or `Pf` (grey), width, height and a scale whose sign is the byte order (negative is
//! little-endian), then 32-bit floats row by row from the bottom. The scale's magnitude means nothing here, as in pbrt-v4.

use super::{Image, Window};

/// The image in a PFM file's bytes, or what is wrong with them.
pub(super) fn decode(bytes: &[u8]) -> Result<Image, String> {
    let mut rest = bytes;
    let channels: &[&str] = match next_word(&mut rest) {
        Some(b"PF") => &["R", "G", "B"],
        Some(b"Pf") => &["Y"],
        _ => return Err("malformed PFM file: it starts with neither PF nor Pf".to_owned()),
    };
    let mut side = |what: &str| {
        let text = next_word(&mut rest).and_then(|word| std::str::from_utf8(word).ok());
        let side = text.and_then(|text| text.parse::<i32>().ok()).filter(|&side| side > 0);
        side.ok_or_else(|| format!("malformed PFM file: no positive {what}"))
    };
    let (width, height) = (side("width")?, side("height")?);
    let scale = next_word(&mut rest).and_then(|word| fast_float2::parse::<f32, _>(word).ok());
    let scale = scale.filter(|scale| scale.is_finite() && *scale != 0.0);
    let scale = scale.ok_or("malformed PFM file: no scale")?;
    // One byte of white space, and the samples.
    let samples = rest.get(1..).unwrap_or_default();
    let window = Window::of_size(width, height);
    let row = window.width() * channels.len();
    let count = window.pixel_count().checked_mul(channels.len());
    let Some(samples) = count.and_then(|count| samples.get(..count.checked_mul(4)?)) else {
        return Err("malformed PFM file: it ends before its last pixel".to_owned());
    };
    let (words, _) = samples.as_chunks::<4>();
    let value = |word: &[u8; 4]| {
        if scale < 0.0 {
            f32::from_le_bytes(*word)
        } else {
            f32::from_be_bytes(*word)
        }
    };
    let data = words.chunks_exact(row).rev().flatten().map(value).collect();
    let names = channels.iter().map(ToString::to_string).collect();
    Image::new(window, window, names, data).map_err(|error| error.to_string())
}

/// The next word of the header.
fn next_word<'a>(rest: &mut &'a [u8]) -> Option<&'a [u8]> {
    let start = rest.iter().position(|b| !b.is_ascii_whitespace())?;
    let text = &rest[start..];
    let end = text.iter().position(u8::is_ascii_whitespace)?;
    *rest = &text[end..];
    Some(&text[..end])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(header: &str, values: &[f32], little: bool) -> Vec<u8> {
        let mut bytes = header.as_bytes().to_vec();
        let word = |v: &f32| if little { v.to_le_bytes() } else { v.to_be_bytes() };
        bytes.extend(values.iter().flat_map(word));
        bytes
    }

    #[test]
    fn rows_come_from_the_bottom_in_either_byte_order() {
        for (header, little) in [("Pf\n2 2\n-1.0\n", true), ("Pf 2 2 1\n", false)] {
            let image = decode(&file(header, &[1.0, 2.0, 3.0, -4.5], little)).unwrap();
            assert_eq!(image.channels(), ["Y"]);
            assert_eq!(image.data(), [3.0, -4.5, 1.0, 2.0]);
        }
        let image = decode(&file("PF\n1 2\n-1\n", &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], true)).unwrap();
        assert_eq!(image.data(), [4.0, 5.0, 6.0, 1.0, 2.0, 3.0]);
    }

    #[test]
    fn what_is_wrong_is_said() {
        for (bytes, message) in [
            (file("P6\n1 1\n-1\n", &[0.0], true), "neither PF nor Pf"),
            (file("Pf\n0 1\n-1\n", &[0.0], true), "width"),
            (file("Pf\n1 x\n-1\n", &[0.0], true), "height"),
            (file("Pf\n1 1\n0\n", &[0.0], true), "scale"),
            (file("Pf\n2 1\n-1\n", &[0.0], true), "ends before"),
            (file("PF\n2147483647 2147483647\n-1\n", &[0.0], true), "ends before"),
            (b"Pf".to_vec(), "neither"),
            (Vec::new(), "neither"),
        ] {
            let found = decode(&bytes).unwrap_err();
            assert!(found.contains(message), "{found}");
        }
    }
}
