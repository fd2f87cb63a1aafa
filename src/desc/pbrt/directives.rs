//! The directives of a pbrt file: reads the arguments of each and has the [`Builder`] carry it out.

use glam::{DAffine3, DVec3};

use super::builder::{Builder, OptionKind};
use super::params::read_params;
use super::report::Report;
use super::state::{affine, look_at};
use super::tokens::{Lexer, Number, Token, TokenKind, unquote};
use crate::error::Span;

/// All of pbrt-v4's.
const DIRECTIVES: [&str; 40] = [
    "Accelerator",
    "ActiveTransform",
    "AreaLightSource",
    "Attribute",
    "AttributeBegin",
    "AttributeEnd",
    "Camera",
    "ColorSpace",
    "ConcatTransform",
    "CoordSysTransform",
    "CoordinateSystem",
    "Film",
    "Identity",
    "Import",
    "Include",
    "Integrator",
    "LightSource",
    "LookAt",
    "MakeNamedMaterial",
    "MakeNamedMedium",
    "Material",
    "MediumInterface",
    "NamedMaterial",
    "ObjectBegin",
    "ObjectEnd",
    "ObjectInstance",
    "Option",
    "PixelFilter",
    "ReverseOrientation",
    "Rotate",
    "Sampler",
    "Scale",
    "Shape",
    "Texture",
    "Transform",
    "TransformBegin",
    "TransformEnd",
    "TransformTimes",
    "Translate",
    "WorldBegin",
];

/// Whether a word starts a directive.
pub(super) fn is_directive(word: &[u8]) -> bool {
    DIRECTIVES.iter().any(|d| d.as_bytes() == word)
}

/// What the main loop is to do next.
pub(super) enum Next {
    /// Read on.
    Continue,
    /// Open the file of this name, named at this place.
    Open { name: String, span: Span, is_import: bool },
}

/// The arguments did not read; this has been reported.
struct Broken;

/// A file's text and where complaints about it go.
struct Arguments<'a> {
    lexer: &'a mut Lexer,
    report: &'a mut Report,
    directive: Span,
}

/// Carries out the directive whose first token is `token`.
pub(super) fn execute(builder: &mut Builder, lexer: &mut Lexer, token: Token) -> Next {
    let word = String::from_utf8_lossy(lexer.bytes(token)).into_owned();
    let done = if token.kind == TokenKind::Word {
        dispatch(builder, lexer, &word, token.span)
    } else {
        let found = builder.context.report.excerpt(token.span);
        builder
            .context
            .report
            .error(token.span, format!("expected a directive, found `{found}`"));
        Err(Broken)
    };
    done.unwrap_or_else(|Broken| {
        skip_to_directive(lexer);
        Next::Continue
    })
}

/// Skips to the next word that is a directive.
fn skip_to_directive(lexer: &mut Lexer) {
    while let Some(token) = lexer.peek() {
        if token.kind == TokenKind::Word && is_directive(lexer.bytes(token)) {
            break;
        }
        lexer.next();
    }
}

fn dispatch(builder: &mut Builder, lexer: &mut Lexer, word: &str, span: Span) -> Result<Next, Broken> {
    if let Some(kind) = OptionKind::of_directive(word) {
        let (name, name_span, params) = entity(builder, lexer, span)?;
        builder.option(kind, name, name_span, params, span);
        return Ok(Next::Continue);
    }
    match word {
        "Include" | "Import" => {
            let (name, name_span) = arguments(builder, lexer, span).string()?;
            let is_import = word == "Import";
            if !is_import || builder.expect_world("Import", span) {
                return Ok(Next::Open {
                    name,
                    span: name_span,
                    is_import,
                });
            }
        }
        "Identity" | "Translate" | "Scale" | "Rotate" | "LookAt" | "Transform" | "ConcatTransform" => {
            transform(builder, lexer, word, span)?;
        }
        "CoordinateSystem" | "CoordSysTransform" | "ActiveTransform" | "TransformTimes" | "ColorSpace" | "Option" => {
            setting(builder, lexer, word, span)?;
        }
        "WorldBegin" => builder.world_begin(span),
        "WorldEnd" if builder.context.report.is_old() => {}
        "AttributeBegin" => builder.attribute_begin(span),
        "AttributeEnd" => builder.attribute_end(span),
        "TransformBegin" | "TransformEnd" => {
            let message = format!(
                "`{word}` is deprecated: it is taken for {}",
                word.replace("Transform", "Attribute")
            );
            builder.context.report.warning(span, message);
            if word == "TransformBegin" {
                builder.attribute_begin(span);
            } else {
                builder.attribute_end(span);
            }
        }
        "ReverseOrientation" => builder.reverse_orientation(span),
        "ObjectEnd" => builder.object_end(span),
        "ObjectBegin" | "ObjectInstance" | "NamedMaterial" => {
            let (name, name_span) = arguments(builder, lexer, span).string()?;
            match word {
                "ObjectBegin" => builder.object_begin(name, name_span, span),
                "ObjectInstance" => builder.object_instance(name, name_span),
                _ => builder.named_material(name, name_span),
            }
        }
        "MediumInterface" => {
            let interior = arguments(builder, lexer, span).string()?;
            let mut exterior = interior.clone();
            if lexer.peek().is_some_and(|t| t.kind == TokenKind::Quoted) {
                exterior = arguments(builder, lexer, span).string()?;
            }
            builder.medium_interface(interior, exterior);
        }
        "Texture" => {
            let name = arguments(builder, lexer, span).string()?;
            let (class, class_span) = arguments(builder, lexer, span).string()?;
            let (kind, kind_span, params) = entity(builder, lexer, span)?;
            builder.texture(name, (&class, class_span), (kind, kind_span), params, span);
        }
        _ if is_directive(word.as_bytes()) => {
            let (name, name_span, params) = entity(builder, lexer, span)?;
            builder.entity(word, name, name_span, params, span);
        }
        _ => {
            let message = format!("unknown directive `{}`", builder.context.report.excerpt(span));
            let report = &mut builder.context.report;
            report.unknown(span, message, "it is skipped", word, &DIRECTIVES);
            return Err(Broken);
        }
    }
    Ok(Next::Continue)
}

fn arguments<'a>(builder: &'a mut Builder, lexer: &'a mut Lexer, directive: Span) -> Arguments<'a> {
    Arguments {
        lexer,
        report: &mut builder.context.report,
        directive,
    }
}

/// The type and the parameters of an entity.
fn entity(
    builder: &mut Builder,
    lexer: &mut Lexer,
    span: Span,
) -> Result<(String, Span, Vec<super::params::Param>), Broken> {
    let (name, name_span) = arguments(builder, lexer, span).string()?;
    let params = read_params(lexer, &mut builder.context.report);
    Ok((name, name_span, params))
}

/// The directives that change the current transform.
fn transform(builder: &mut Builder, lexer: &mut Lexer, word: &str, span: Span) -> Result<(), Broken> {
    let mut arguments = arguments(builder, lexer, span);
    let vector = |v: &[f64]| DVec3::new(v[0], v[1], v[2]);
    let (change, replaces) = match word {
        "Identity" => (Some(DAffine3::IDENTITY), true),
        "Translate" => (
            Some(DAffine3::from_translation(vector(&arguments.numbers::<3>()?))),
            false,
        ),
        "Scale" => (Some(DAffine3::from_scale(vector(&arguments.numbers::<3>()?))), false),
        "Rotate" => {
            let v = arguments.numbers::<4>()?;
            let axis = vector(&v[1..]).try_normalize();
            (
                axis.map(|axis| DAffine3::from_axis_angle(axis, v[0].to_radians())),
                false,
            )
        }
        "LookAt" => {
            let v = arguments.numbers::<9>()?;
            (look_at(vector(&v[..3]), vector(&v[3..6]), vector(&v[6..])), false)
        }
        _ => (affine(&arguments.bracketed::<16>()?), word == "Transform"),
    };
    let Some(change) = change else {
        let problem = match word {
            "Rotate" => "the axis of this rotation is zero",
            "LookAt" => "the viewing direction of this `LookAt` is zero, or its up vector is zero or parallel to it",
            _ => "this matrix is not affine: every fourth number but the last must be 0, and the last must not be",
        };
        builder.context.report.error(span, problem);
        return Ok(());
    };
    let apply = |ctm: DAffine3| if replaces { change } else { ctm * change };
    if !builder.state.transform(apply) {
        let problem = "this makes the current transform singular or not finite";
        builder.context.report.error(span, problem);
    }
    Ok(())
}

/// The directives that set something else of the graphics state, or an option.
fn setting(builder: &mut Builder, lexer: &mut Lexer, word: &str, span: Span) -> Result<(), Broken> {
    let mut arguments = arguments(builder, lexer, span);
    match word {
        "ActiveTransform" => {
            let choices = [
                ("All", [true, true]),
                ("StartTime", [true, false]),
                ("EndTime", [false, true]),
            ];
            let (choice, choice_span) = arguments.word()?;
            if let Some(&(_, active)) = choices.iter().find(|&&(name, _)| name == choice) {
                builder.state.active = active;
            } else {
                let message = format!("expected `All`, `StartTime` or `EndTime`, found `{choice}`");
                builder.context.report.error(choice_span, message);
            }
        }
        "TransformTimes" => {
            let [start, end] = arguments.numbers::<2>()?;
            builder.transform_times(start, end, span);
        }
        "Option" => {
            let (name, _) = arguments.string()?;
            let (value, _) = arguments.word()?;
            builder.render_option(&name, &value, span);
        }
        _ => {
            let (name, name_span) = arguments.string()?;
            match word {
                "CoordinateSystem" => builder.coordinate_system(name),
                "CoordSysTransform" => builder.coord_sys_transform(&name, name_span),
                _ => builder.color_space(&name, name_span),
            }
        }
    }
    Ok(())
}

impl Arguments<'_> {
    /// A quoted string.
    fn string(&mut self) -> Result<(String, Span), Broken> {
        let token = self.expect("a string in double quotes", TokenKind::Quoted)?;
        match unquote(self.lexer.bytes(token)) {
            Ok(text) => Ok((text, token.span)),
            Err(problem) => {
                self.report.error(token.span, problem);
                Err(Broken)
            }
        }
    }

    /// A word or a quoted string, with its quotes.
    fn word(&mut self) -> Result<(String, Span), Broken> {
        let quoted = self.lexer.peek().is_some_and(|t| t.kind == TokenKind::Quoted);
        let kind = if quoted { TokenKind::Quoted } else { TokenKind::Word };
        let token = self.expect("a value", kind)?;
        Ok((self.report.excerpt(token.span), token.span))
    }

    /// So many numbers.
    fn numbers<const N: usize>(&mut self) -> Result<[f64; N], Broken> {
        let mut numbers = [0.0; N];
        for (i, number) in numbers.iter_mut().enumerate() {
            let Number::Value(value) = self.lexer.number() else {
                let found = self.lexer.peek();
                let what = found.map_or("the end of the file".to_owned(), |t| {
                    format!("`{}`", self.report.excerpt(t.span))
                });
                let message = format!("expected {N} finite numbers, found {what} after {i}");
                self.report.error(found.map_or(self.directive, |t| t.span), message);
                return Err(Broken);
            };
            *number = value;
        }
        Ok(numbers)
    }

    /// So many numbers in brackets.
    fn bracketed<const N: usize>(&mut self) -> Result<[f64; N], Broken> {
        self.expect("`[`", TokenKind::Open)?;
        let numbers = self.numbers()?;
        self.expect("`]`", TokenKind::Close)?;
        Ok(numbers)
    }

    fn expect(&mut self, what: &str, kind: TokenKind) -> Result<Token, Broken> {
        let found = self.lexer.peek();
        if let Some(token) = found.filter(|t| t.kind == kind) {
            self.lexer.next();
            return Ok(token);
        }
        let instead = found.map_or("the end of the file".to_owned(), |t| {
            format!("`{}`", self.report.excerpt(t.span))
        });
        let span = found.map_or(self.directive, |t| t.span);
        self.report.error(span, format!("expected {what}, found {instead}"));
        Err(Broken)
    }
}
