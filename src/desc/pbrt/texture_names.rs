//! The textures of a scene by class and name. A material may name a texture before it is defined, as in pbrt-v4; a texture may not.

use std::collections::HashMap;

use super::report::Report;
use super::suggest;
use crate::desc::{ClassedTexture, SpectrumDesc, SpectrumValue, TextureClass, TextureDesc, TextureId, TextureKind};
use crate::error::Span;

/// Textures in slots: a name gets its slot when it is first mentioned.
#[derive(Debug, Default)]
pub(super) struct Textures {
    slots: Vec<Slot>,
    names: HashMap<(TextureClass, String), TextureId>,
}

#[derive(Debug)]
struct Slot {
    class: TextureClass,
    name: String,
    /// Where it was first mentioned.
    span: Span,
    /// The texture, and how many textures in a row it is on top of; none before its definition.
    defined: Option<(TextureDesc, u32)>,
}

impl Textures {
    /// The texture of a name that is used at `span`.
    pub fn named(&mut self, class: TextureClass, name: &str, span: Span) -> TextureId {
        let slots = &mut self.slots;
        *self.names.entry((class, name.to_owned())).or_insert_with(|| {
            slots.push(Slot {
                class,
                name: name.to_owned(),
                span,
                defined: None,
            });
            // There are fewer textures than bytes in a file.
            TextureId(slots.len() as u32 - 1)
        })
    }

    /// How many textures in a row one is on top of, itself included; `None` before its definition.
    pub fn depth(&self, id: TextureId) -> Option<u32> {
        self.slots[id.0 as usize].defined.as_ref().map(|&(_, depth)| depth)
    }

    /// Whether a texture of this name is defined.
    pub fn is_defined(&self, class: TextureClass, name: &str) -> bool {
        let id = self.names.get(&(class, name.to_owned()));
        id.is_some_and(|&id| self.depth(id).is_some())
    }

    /// Defines a texture that is on top of `depth` others in a row; what names it from here on means this one.
    pub fn define(&mut self, class: TextureClass, texture: TextureDesc, depth: u32) {
        if self.is_defined(class, &texture.name) {
            self.names.remove(&(class, texture.name.clone()));
        }
        let id = self.named(class, &texture.name.clone(), texture.span);
        self.slots[id.0 as usize].defined = Some((texture, depth + 1));
    }

    /// What to say of a name that is not defined.
    pub fn help(&self, class: TextureClass, name: &str) -> Option<String> {
        let other = match class {
            TextureClass::Float => TextureClass::Spectrum,
            TextureClass::Spectrum => TextureClass::Float,
        };
        if self.is_defined(other, name) {
            return Some(format!("there is a {} texture of that name", other.name()));
        }
        let defined = self
            .slots
            .iter()
            .filter(|slot| slot.class == class && slot.defined.is_some());
        let known: Vec<&str> = defined.map(|slot| slot.name.as_str()).collect();
        suggest::closest(name, &known).map(|name| format!("did you mean `{name}`?"))
    }

    /// All textures; complains about those that are not defined, for which a constant stands in.
    pub fn finish(self, report: &mut Report) -> Vec<TextureDesc> {
        for slot in self.slots.iter().filter(|slot| slot.defined.is_none()) {
            let message = format!("there is no {} texture `{}`", slot.class.name(), slot.name);
            let help = self.help(slot.class, &slot.name);
            report.unsupported_with_help(slot.span, message, "a constant stands in", help);
        }
        let texture = |slot: Slot| match slot.defined {
            Some((texture, _)) => texture,
            None => TextureDesc {
                kind: stand_in(slot.class, slot.span),
                name: slot.name,
                world_from_texture: glam::DAffine3::IDENTITY,
                span: slot.span,
            },
        };
        self.slots.into_iter().map(texture).collect()
    }
}

/// What stands in for a texture that is not to be had.
pub(super) fn stand_in(class: TextureClass, span: Span) -> ClassedTexture {
    match class {
        TextureClass::Float => ClassedTexture::Float(TextureKind::Constant(1.0)),
        TextureClass::Spectrum => ClassedTexture::Spectrum(TextureKind::Constant(SpectrumDesc {
            value: SpectrumValue::Constant(0.5),
            span,
        })),
    }
}
