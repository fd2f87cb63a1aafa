//! Who may import whom: the module levels of `src/lib.rs`, and where `unsafe` may be, read off the sources.

use std::fs;
use std::path::{Path, PathBuf};

/// The levels, from below: a module may use those of earlier lines and itself. `main` is the file beside `lib.rs`.
const LEVELS: &[&[&str]] = &[
    &["error", "math"],
    &["sampling", "spectrum", "image_io"],
    &["desc", "geometry"],
    &["texture"],
    &["accel", "medium"],
    &["material", "light", "camera", "film"],
    &["scene"],
    &["integrator"],
    &["bench"],
    &["cli"],
    &["main"],
];

/// Where `unsafe` is allowed, as module paths.
const UNSAFE: &[&str] = &["accel::embree", "accel::bvh"];

/// What the crate root re-exports, and from where.
const ROOT_NAMES: &[(&str, &str)] = &[("Error", "error"), ("Result", "error")];

/// A source file as its module path (`["accel", "bvh", "node"]`) and text.
struct Source {
    module: Vec<String>,
    text: String,
}

#[test]
fn modules_import_upward_only() {
    let problems: Vec<String> = sources().iter().flat_map(import_problems).collect();
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

#[test]
fn every_module_of_the_crate_has_a_level() {
    let modules: Vec<String> = sources().iter().map(|s| s.module[0].clone()).collect();
    assert!(modules.len() > 50, "only {} files were found", modules.len());
    for module in modules.iter().filter(|&module| module != "lib") {
        assert!(
            level(module).is_some(),
            "`{module}` is on no level of tests/architecture.rs"
        );
    }
}

#[test]
fn unsafe_is_where_it_may_be() {
    let problems: Vec<String> = sources().iter().filter_map(unsafe_problem).collect();
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

/// The checks themselves, on sources that break the rules.
#[test]
fn violations_are_found() {
    let problems = |module: &str, text: &str| import_problems(&source(module, text));
    for (module, text) in [
        ("math::frame", "use crate::sampling::warp;"),
        ("accel::bvh", "fn f() -> crate::material::Bsdf { todo!() }"),
        ("light::area", "use crate::{error::Result, material::Bsdf};"),
        ("light::area", "use crate::{\n    error::Result,\n    camera,\n};"),
        ("film::sums", "use super::super::material;"),
        ("film", "use super::scene::Scene;"),
        ("film", "mod tests {\n    use super::super::camera;\n}"),
        ("film", "mod tests { fn f() { if x {} } }\nuse super::camera;"),
        ("sampling::warp::plane", "use super::super::super::spectrum::cie;"),
        ("geometry", "pub(crate) use crate :: desc :: MeshDesc;"),
        ("desc::pbrt", "use crate::*;"),
        ("integrator", "use lucerna::cli;"),
        ("error", "/* ... */ type A = crate::math::Vec3;"),
        ("scene", "use crate::unheard_of;"),
    ] {
        assert_eq!(problems(module, text).len(), 1, "{module}: {text}");
    }
    for (module, text) in [
        ("math::frame", "use super::Vec3;\nuse crate::math::Vec2;"),
        (
            "accel::bvh::tree",
            "use crate::geometry::{Ray, World};\nuse super::super::Accel;",
        ),
        (
            "accel::bvh",
            "//! Not a material: see [`crate::material`].\n/// crate::light\nfn f() {}",
        ),
        (
            "material::bsdf",
            "use crate::{Error, Result, sampling::{self, mis}, math::Vec2};",
        ),
        ("cli", "use crate::{bench, integrator, scene as s, desc::*};"),
        ("math", "const S: &str = \"crate::scene\";"),
        ("camera", "mod tests {\n    use super::*;\n}"),
        ("film::sums", "mod tests {\n    use super::super::lens;\n}"),
    ] {
        assert_eq!(problems(module, text), [""; 0], "{module}: {text}");
    }

    assert!(unsafe_problem(&source("accel::bvh::avx2", "unsafe { f() }")).is_none());
    assert!(unsafe_problem(&source("accel::brute", "unsafe { f() }")).is_some());
    assert!(unsafe_problem(&source("film", "pub unsafe fn f() {}")).is_some());
    assert!(
        unsafe_problem(&source(
            "film",
            "// unsafe\n#![deny(unsafe_code)] fn f() { \"unsafe\"; }"
        ))
        .is_none()
    );
}

fn level(module: &str) -> Option<usize> {
    LEVELS.iter().position(|line| line.contains(&module))
}

fn source(module: &str, text: &str) -> Source {
    Source {
        module: module.split("::").map(str::to_owned).collect(),
        text: text.to_owned(),
    }
}

/// Every file under `src`.
fn sources() -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    collect(&root, &mut files);
    files
        .iter()
        .map(|path| {
            let relative = path.strip_prefix(&root).expect("under src").with_extension("");
            let mut module: Vec<String> = relative
                .iter()
                .map(|part| part.to_string_lossy().into_owned())
                .collect();
            if module.last().is_some_and(|name| name == "mod") {
                module.pop();
            }
            Source {
                module,
                text: fs::read_to_string(path).expect("a readable source"),
            }
        })
        .collect()
}

fn collect(directory: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(directory).expect("a readable directory") {
        let path = entry.expect("a readable entry").path();
        if path.is_dir() {
            collect(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
}

/// What a file names of modules that it must not know.
fn import_problems(source: &Source) -> Vec<String> {
    let [own, ..] = source.module.as_slice() else {
        return Vec::new();
    };
    if own == "lib" {
        return Vec::new();
    }
    let allowed = |module: &str| module == own || level(module) < level(own) && level(module).is_some();
    used_modules(source)
        .into_iter()
        .filter(|used| !allowed(used))
        .map(|used| format!("{}: must not use `{used}`", source.module.join("::")))
        .collect()
}

/// The top-level modules that the paths of a file lead to, each once.
fn used_modules(source: &Source) -> Vec<String> {
    let tokens = tokens(&source.text);
    let is = |i: usize, text: &str| tokens.get(i).is_some_and(|token| token == text);
    let mut used = Vec::new();
    // The depths of the braces that inline modules (of tests) are in.
    let (mut braces, mut inline) = (0, Vec::new());
    for i in 0..tokens.len() {
        match tokens[i].as_str() {
            "{" => {
                braces += 1;
                if i >= 2 && tokens[i - 2] == "mod" {
                    inline.push(braces);
                }
            }
            "}" => {
                if inline.last() == Some(&braces) {
                    inline.pop();
                }
                braces -= 1;
            }
            // A path begins where no `::` stands before it.
            "crate" | "lucerna" if (i == 0 || !is(i - 1, "::")) && is(i + 1, "::") => {
                used.extend(first_names(&tokens[i + 2..]));
            }
            "super" if i == 0 || !is(i - 1, "::") => {
                let mut supers = 1;
                while is(i + 2 * supers, "super") {
                    supers += 1;
                }
                // As many as the module is deep lead to the root.
                if supers == source.module.len() + inline.len() {
                    used.extend(first_names(&tokens[i + 2 * supers..]));
                }
            }
            _ => {}
        }
    }
    used.sort();
    used.dedup();
    used
}

/// The first names of a path, or of each path in braces.
fn first_names(tokens: &[String]) -> Vec<String> {
    let module = |name: &str| {
        let root = ROOT_NAMES.iter().find(|(known, _)| *known == name);
        root.map_or(name, |(_, module)| *module).to_owned()
    };
    match tokens.first().map(String::as_str) {
        Some("{") => {
            let mut names = Vec::new();
            let (mut depth, mut expects) = (0, false);
            for token in tokens {
                match token.as_str() {
                    "{" => {
                        depth += 1;
                        expects = depth == 1;
                    }
                    "}" => {
                        depth -= 1;
                        if depth == 0 {
                            break;
                        }
                    }
                    "," => expects = depth == 1,
                    name if expects => {
                        names.push(module(name));
                        expects = false;
                    }
                    _ => {}
                }
            }
            names
        }
        Some(name) => vec![module(name)],
        None => Vec::new(),
    }
}

fn unsafe_problem(source: &Source) -> Option<String> {
    let path = source.module.join("::");
    let allowed = UNSAFE
        .iter()
        .any(|allowed| path == *allowed || path.starts_with(&format!("{allowed}::")));
    let found = tokens(&source.text).iter().any(|token| token == "unsafe");
    (found && !allowed).then(|| format!("{path}: `unsafe` is not allowed here"))
}

/// Words, `::` and single signs, without comments, strings and characters.
fn tokens(text: &str) -> Vec<String> {
    let chars: Vec<char> = text.chars().collect();
    let at = |i: usize| chars.get(i).copied().unwrap_or('\0');
    let word = |c: char| c.is_alphanumeric() || c == '_';
    let mut tokens = Vec::new();
    let mut i = 0;
    while i < chars.len() {
        match at(i) {
            '/' if at(i + 1) == '/' => i = find(&chars, i, "\n"),
            '/' if at(i + 1) == '*' => i = find(&chars, i + 2, "*/"),
            'r' if at(i + 1) == '"' => i = find(&chars, i + 2, "\""),
            'r' if at(i + 1) == '#' && at(i + 2) == '"' => i = find(&chars, i + 3, "\"#"),
            '"' => {
                i += 1;
                while i < chars.len() && at(i) != '"' {
                    i += if at(i) == '\\' { 2 } else { 1 };
                }
                i += 1;
            }
            // A character; a lifetime has no closing quote.
            '\'' if at(i + 1) == '\\' => i = find(&chars, i + 3, "'"),
            '\'' if at(i + 2) == '\'' => i += 3,
            ':' if at(i + 1) == ':' => {
                tokens.push("::".to_owned());
                i += 2;
            }
            c if word(c) => {
                let start = i;
                while word(at(i)) {
                    i += 1;
                }
                tokens.push(chars[start..i].iter().collect());
            }
            c => {
                if !c.is_whitespace() {
                    tokens.push(c.to_string());
                }
                i += 1;
            }
        }
    }
    tokens
}

/// The place after the next `pattern`, or the end.
fn find(chars: &[char], from: usize, pattern: &str) -> usize {
    let pattern: Vec<char> = pattern.chars().collect();
    (from..chars.len())
        .find(|&i| chars[i..].starts_with(&pattern))
        .map_or(chars.len(), |i| i + pattern.len())
}
