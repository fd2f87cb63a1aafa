//! pbrt-v3 files, translated to pbrt-v4 directive by directive before anything reads their parameters.
//!
//! A file is pbrt-v3 if it ends with `WorldEnd` or its film is an `image`; then names that pbrt-v4 has given up are known, and what is
//! left out has the default of then. The guide is pbrt-v4's `--upgrade`, but where a number meant something else it is
//! converted: the picture is to be that of pbrt-v3. What has no counterpart is an error, what is nearly the same a warning; each
//! kind of translation is reported once.

mod lights;
mod materials;
mod old;
mod options;
mod textures;

use super::params::Param;
use super::report::Report;
use crate::error::Span;
use old::Old;

/// Where a pbrt-v3 file ends: the place of `WorldEnd`, if it is the last directive of a text.
pub(super) fn world_end(text: &[u8]) -> Option<usize> {
    const WORD: &[u8] = b"WorldEnd";
    // Comments may follow.
    const FARTHEST: usize = 4096;
    let tail = text.len().saturating_sub(FARTHEST);
    let mut line_start = text.len();
    for line in text[tail..].split(|&b| b == b'\n').rev() {
        line_start -= line.len();
        let indent = line.len() - line.trim_ascii_start().len();
        let word = line.trim_ascii_start();
        if word.starts_with(WORD) && word.get(WORD.len()).is_none_or(u8::is_ascii_whitespace) {
            return Some(line_start + indent);
        }
        if !(word.is_empty() || word.starts_with(b"#")) {
            return None;
        }
        line_start = line_start.saturating_sub(1);
    }
    None
}

/// Translates a directive of a type and parameters to pbrt-v4, where a file is pbrt-v3: `kind` is the type at `span`. Whether
/// anything is left of it.
pub(super) fn translate(
    report: &mut Report,
    directive: &str,
    kind: &mut String,
    span: Span,
    params: &mut Vec<Param>,
) -> bool {
    if directive == "Film" && kind == "image" {
        report.set_old(span);
    }
    if !report.is_old() {
        return true;
    }
    let mut old = Old { report, params, span };
    match directive {
        "Film" => options::film(&mut old, kind),
        "Sampler" => options::sampler(&mut old, kind),
        "PixelFilter" => options::filter(&mut old, kind),
        "Integrator" => options::integrator(&mut old, kind),
        "Camera" => options::camera(&mut old, kind),
        "Material" => materials::material(&mut old, kind),
        "MakeNamedMaterial" => materials::named(&mut old),
        "LightSource" | "AreaLightSource" => lights::light(&mut old, kind),
        "Texture" => textures::texture(&mut old, kind),
        "Shape" => return textures::shape(&mut old, kind),
        _ => {}
    }
    true
}

#[cfg(test)]
mod tests {
    use super::world_end;

    #[test]
    fn world_end_is_found_at_the_end_only() {
        assert_eq!(world_end(b"WorldBegin\nWorldEnd"), Some(11));
        assert_eq!(world_end(b"WorldBegin\n  WorldEnd # so\n\n# long ago\n"), Some(13));
        assert_eq!(world_end(b"WorldEnd"), Some(0));
        assert_eq!(world_end(b"WorldEnd\nShape \"sphere\""), None);
        assert_eq!(world_end(b"WorldEnding\n"), None);
        assert_eq!(world_end(b""), None);
        let far = format!("WorldEnd\n{}", "#\n".repeat(4096));
        assert_eq!(world_end(far.as_bytes()), None);
    }
}
