//! What begins and ends: attributes, objects, files that `Import` opens.

use super::builder::Builder;
use super::state::{Block, GraphicsState, Saved};
use crate::error::Span;

impl Builder {
    /// Saves the graphics state, to be restored at the end of what begins at `span`.
    pub(super) fn save(&mut self, why: Block, span: Span) {
        self.saved.push(Saved {
            state: self.state.clone(),
            why,
            span,
        });
    }

    fn set_state(&mut self, state: GraphicsState) {
        self.context.color_space = state.color_space;
        self.state = state;
    }

    /// Goes back to the last saved state if it was saved for the same reason; otherwise complains.
    pub(super) fn restore(&mut self, why: Block, directive: &str, span: Span) {
        match self.saved.pop() {
            Some(saved) if saved.why == why => self.set_state(saved.state),
            other => {
                let open = match other.as_ref().map(|s| s.why) {
                    Some(Block::Attribute) => "what was begun last is `AttributeBegin`",
                    Some(Block::Object) => "what was begun last is `ObjectBegin`",
                    Some(Block::Import) | None => "nothing has been begun in this file",
                };
                self.saved.extend(other);
                self.context
                    .report
                    .error(span, format!("`{directive}` without a matching begin: {open}"));
            }
        }
    }

    /// A file has been opened by `Import`, whose argument is at `span`.
    pub fn import_begin(&mut self, span: Span) {
        self.save(Block::Import, span);
    }

    /// A file that `Import` opened has ended.
    pub fn import_end(&mut self) {
        while let Some(saved) = self.saved.pop() {
            let is_import = saved.why == Block::Import;
            if !is_import {
                self.unclosed(&saved);
            }
            self.set_state(saved.state);
            if is_import {
                break;
            }
        }
    }

    /// The main file has ended; `end` is there.
    pub fn end(&mut self, end: Span) {
        while let Some(saved) = self.saved.pop() {
            self.unclosed(&saved);
        }
        if !self.in_world {
            let message = "the file ends before `WorldBegin`: it describes no scene";
            self.context.report.error(end, message);
        }
    }

    fn unclosed(&mut self, saved: &Saved) {
        let missing = match saved.why {
            Block::Attribute => "`AttributeEnd`",
            Block::Object => {
                self.world.end_object();
                "`ObjectEnd`"
            }
            Block::Import => return,
        };
        self.context
            .report
            .error(saved.span, format!("the {missing} for this is missing"));
    }
}
