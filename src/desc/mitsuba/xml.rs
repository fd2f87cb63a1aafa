//! From files to elements: XML with places, `$parameters` replaced, `<include>`d files in their place.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::parameters::Parameters;
use crate::desc::report::Report;
use crate::desc::{ParseOptions, bytes};
use crate::error::Span;

/// An element with what is in it.
#[derive(Debug)]
pub(super) struct Element {
    pub tag: String,
    /// The whole start tag.
    pub span: Span,
    pub attributes: Vec<Attribute>,
    pub children: Vec<Element>,
}

/// An attribute, its parameters replaced.
#[derive(Debug)]
pub(super) struct Attribute {
    pub name: String,
    pub value: String,
    /// Of the value, without its quotes.
    pub span: Span,
    pub name_span: Span,
}

impl Element {
    /// The attribute of this name.
    pub fn attribute(&self, name: &str) -> Option<&Attribute> {
        self.attributes.iter().find(|a| a.name == name)
    }

    /// Complains about attributes that are not among these, and about `required` ones that are missing; whether all is well.
    pub fn check(&self, report: &mut Report, required: &[&str], optional: &[&str]) -> bool {
        let mut fine = true;
        for attribute in &self.attributes {
            let name = attribute.name.as_str();
            if !required.contains(&name) && !optional.contains(&name) {
                let known: Vec<&str> = required.iter().chain(optional).copied().collect();
                let message = format!("<{}> has no attribute `{name}`", self.tag);
                let help = crate::desc::suggest::closest(name, &known).map(|name| format!("did you mean `{name}`?"));
                report.error_with_help(attribute.name_span, message, help);
                fine = false;
            }
        }
        for name in required {
            if self.attribute(name).is_none() {
                report.error(self.span, format!("<{}> needs the attribute `{name}`", self.tag));
                fine = false;
            }
        }
        fine
    }
}

/// Elements are not nested deeper, files not included deeper, and not more files included than this.
const DEEPEST: usize = 100;
const DEEPEST_INCLUDE: usize = 15;
const MOST_INCLUDES: usize = 1000;

/// Spans count bytes in 32 bits.
const LONGEST_TEXT: u64 = u32::MAX as u64;

/// What has been read so far.
#[derive(Debug)]
pub(super) struct XmlReader {
    pub report: Report,
    pub hasher: blake3::Hasher,
    pub parameters: Parameters,
    /// Where files are looked for, first to last: `<path>`s, then the directory of the main file.
    pub directories: Vec<PathBuf>,
    /// The files being read, to find cycles.
    open: Vec<PathBuf>,
    includes: usize,
    /// (major, minor, patch) of the main file.
    pub version: [u32; 3],
}

impl XmlReader {
    pub fn new(path: &Path, options: &ParseOptions) -> Self {
        Self {
            report: Report::new(options),
            hasher: blake3::Hasher::new(),
            parameters: Parameters::new(&options.defines),
            directories: vec![path.parent().unwrap_or(Path::new("")).to_owned()],
            open: Vec::new(),
            includes: 0,
            version: [3, 0, 0],
        }
    }

    /// A file that the scene names.
    pub fn resolve(&self, name: &str) -> PathBuf {
        let mut found = self.directories.iter().map(|directory| directory.join(name));
        let first = found.clone().next().unwrap_or_else(|| PathBuf::from(name));
        found.find(|path| path.exists()).unwrap_or(first)
    }

    /// Counts the content of a file in the hash of the scene.
    pub fn count(&mut self, content: &[u8]) {
        self.hasher.update(&(content.len() as u64).to_le_bytes());
        self.hasher.update(content);
    }

    /// The root of a text; none if it is not well-formed, which is said.
    pub fn read(&mut self, path: &Path, text: Vec<u8>) -> Option<Element> {
        self.count(&text);
        let text: Arc<[u8]> = Arc::from(text);
        let file = self.report.add_file(path, Arc::clone(&text));
        let place = |at: usize| Span {
            file,
            start: at as u32,
            end: at as u32 + 1,
        };
        let text = match std::str::from_utf8(&text) {
            Ok(text) => text,
            Err(e) => {
                self.report.error(place(e.valid_up_to()), "this is not UTF-8");
                return None;
            }
        };
        if let Some(at) = too_deep(text) {
            let message = format!("elements are nested deeper than {DEEPEST}");
            self.report.error(place(at), message);
            return None;
        }
        let document = match roxmltree::Document::parse(text) {
            Ok(document) => document,
            Err(e) => {
                let pos = e.pos();
                let line = text.split_inclusive('\n').take(pos.row.saturating_sub(1) as usize);
                let line_start: usize = line.map(str::len).sum();
                let column = text[line_start..]
                    .char_indices()
                    .nth(pos.col.saturating_sub(1) as usize);
                let at = column.map_or(text.len(), |(at, _)| line_start + at);
                // The crate ends its messages with the place, which is said already.
                let message = e.to_string();
                let message = message.rsplit_once(" at ").map_or(message.as_str(), |(what, _)| what);
                self.report.error(place(at), format!("not well-formed XML: {message}"));
                return None;
            }
        };
        self.open.push(path.canonicalize().unwrap_or_else(|_| path.to_owned()));
        let root = self.element(document.root_element(), file);
        self.open.pop();
        root
    }

    /// An element and all in it; `<default>`, `<include>` and `<path>` are carried out, and leave nothing.
    fn element(&mut self, node: roxmltree::Node<'_, '_>, file: u32) -> Option<Element> {
        let span = |range: std::ops::Range<usize>| Span {
            file,
            start: range.start as u32,
            end: range.end as u32,
        };
        let text = node.document().input_text();
        let whole = node.range();
        let start_tag = text[whole.clone()].find('>').map_or(whole.end, |i| whole.start + i + 1);
        let mut element = Element {
            tag: node.tag_name().name().to_owned(),
            span: span(whole.start..start_tag),
            attributes: Vec::new(),
            children: Vec::new(),
        };
        for attribute in node.attributes() {
            let value_span = span(attribute.range_value());
            let value = match self.parameters.replace(attribute.value()) {
                Ok(value) => value,
                Err((message, help)) => {
                    self.report.error_with_help(value_span, message, help);
                    return None;
                }
            };
            element.attributes.push(Attribute {
                name: attribute.name().to_owned(),
                value,
                span: value_span,
                name_span: span(attribute.range_qname()),
            });
        }
        for child in node.children() {
            if self.report.is_full() {
                break;
            }
            if child.is_text() && !child.text().unwrap_or_default().trim().is_empty() {
                let text = child.range();
                let start = text.start
                    + child
                        .text()
                        .unwrap_or_default()
                        .find(|c: char| !c.is_whitespace())
                        .unwrap_or(0);
                let message = format!("text inside <{}>: values are given by attributes", element.tag);
                self.report.error(span(start..text.end.max(start + 1)), message);
            }
            if !child.is_element() {
                continue;
            }
            let Some(child) = self.element(child, file) else {
                continue;
            };
            self.place(&mut element, child);
        }
        Some(element)
    }

    /// Puts an element into its parent, or does what it says.
    fn place(&mut self, parent: &mut Element, child: Element) {
        match child.tag.as_str() {
            "default" => {
                if child.check(&mut self.report, &["name", "value"], &[])
                    && let (Some(name), Some(value)) = (child.attribute("name"), child.attribute("value"))
                {
                    if name.value.is_empty() {
                        self.report.error(name.span, "the name of a <default> is empty");
                    } else {
                        self.parameters.add_default(&name.value, &value.value);
                    }
                }
            }
            "include" => {
                if child.check(&mut self.report, &["filename"], &["name"])
                    && let Some(name) = child.attribute("filename")
                    && let Some(root) = self.include(&name.value, name.span)
                {
                    if root.tag == "scene" {
                        parent.children.extend(root.children);
                    } else {
                        parent.children.push(root);
                    }
                }
            }
            "path" => {
                if child.check(&mut self.report, &["value"], &[])
                    && let Some(value) = child.attribute("value")
                {
                    let directory = self.resolve(&value.value);
                    if directory.is_dir() {
                        self.directories.insert(0, directory);
                    } else {
                        let message = format!("there is no directory {}", directory.display());
                        self.report.error(value.span, message);
                    }
                }
            }
            _ => parent.children.push(child),
        }
    }

    fn include(&mut self, name: &str, span: Span) -> Option<Element> {
        let path = self.resolve(name);
        let canonical = path.canonicalize().unwrap_or_else(|_| path.clone());
        self.includes += 1;
        let problem = if self.open.contains(&canonical) {
            format!("{} includes itself", path.display())
        } else if self.open.len() > DEEPEST_INCLUDE {
            format!("more than {DEEPEST_INCLUDE} files include one another")
        } else if self.includes > MOST_INCLUDES {
            format!("more than {MOST_INCLUDES} files are included")
        } else {
            match bytes::read(&path, LONGEST_TEXT) {
                Ok(text) => {
                    // Names in a file are looked for beside it first.
                    let directory = path.parent().unwrap_or(Path::new("")).to_owned();
                    self.directories.insert(0, directory.clone());
                    let root = self.read(&path, text);
                    if let Some(at) = self.directories.iter().position(|d| *d == directory) {
                        let beside = self.directories.remove(at);
                        self.directories.push(beside);
                    }
                    return root;
                }
                Err(e) => format!("cannot read {}: {e}", path.display()),
            }
        };
        self.report.error(span, problem);
        None
    }
}

/// Where elements first are nested too deep: a parser that recurses must not see such a text. (What looks like a tag in a comment or
/// a quoted value counts as well.)
fn too_deep(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let mut depth = 0_usize;
    let mut at = 0;
    while let Some(next) = bytes[at..].iter().position(|&b| b == b'<') {
        let start = at + next;
        if text[start..].starts_with("<!--") {
            at = text[start..].find("-->").map_or(bytes.len(), |end| start + end + 3);
            continue;
        }
        let end = bytes[start..]
            .iter()
            .position(|&b| b == b'>')
            .map_or(bytes.len(), |i| start + i);
        match bytes.get(start + 1) {
            Some(b'/') => depth = depth.saturating_sub(1),
            Some(b'?' | b'!') | None => {}
            Some(_) if bytes[end.saturating_sub(1)] == b'/' => {}
            Some(_) => {
                depth += 1;
                if depth > DEEPEST {
                    return Some(start);
                }
            }
        }
        at = end;
    }
    None
}
