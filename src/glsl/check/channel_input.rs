//! `iCh0` to `iCh3`, which the site declares in Image tabs as structures with a sampler: `uniform struct {
//! sampler2D sampler; vec3 size; float time; int loaded; } iCh0;`. Only their members can be used, and these
//! are the other inputs.

use toyproof_diagnostic::{Code, nearest};

use super::Checker;
use super::scope::did_you_mean;
use crate::Stage;
use crate::token::Symbol;
use crate::tree::{
    BinaryOp, ExprId, ExprKind, Input, Literal, Place, Value, Variable, VariableId, VariableKind,
};

const MEMBERS: [&str; 4] = ["sampler", "size", "time", "loaded"];
const MEMBERS_NOTE: &str = "its members are `sampler`, `size`, `time` and `loaded`";

impl Checker<'_> {
    /// The number of the channel, if the name is `iCh0` to `iCh3`.
    pub(crate) fn channel_input(&self, name: Symbol) -> Option<u8> {
        let number = self.text(name).strip_prefix("iCh")?;
        let channel = ["0", "1", "2", "3"].iter().position(|known| *known == number)?;
        (self.stage == Stage::Image && !self.is_declared(name)).then_some(channel as u8)
    }

    /// Reports `iCh0` without a member.
    pub(crate) fn unselected_channel_input(&mut self, channel: u8, at: Place) -> ExprId {
        let message =
            format!("`iCh{channel}` is a structure without a type name, of which only members can be used");
        self.refuse_with(Code::UnknownMember.at(at, message).note(MEMBERS_NOTE), at)
    }

    /// Checks `iCh0.size`.
    pub(crate) fn channel_member(&mut self, channel: u8, member: Symbol, at: Place) -> ExprId {
        match self.text(member) {
            "sampler" => self.input(VariableKind::Channel(channel), at),
            "size" => self.of_channel(Input::ChannelResolution, channel, at),
            "time" => self.of_channel(Input::ChannelTime, channel, at),
            "loaded" => {
                // A channel without a texture has the size 0.
                let size = self.of_channel(Input::ChannelResolution, channel, at);
                let [zero, one] = [0, 1].map(|value| self.int_literal(value, at));
                let width = self.index(size, zero, at);
                let nothing = Literal::new("0.0", Value::Float(0.0));
                let nothing = self.literal(nothing, at);
                let is_loaded = self.binary(BinaryOp::Greater, width, nothing);
                self.conditional(is_loaded, one, zero)
            }
            text => {
                let near = nearest(text, MEMBERS);
                let message = format!("`iCh{channel}` has no member `{text}`");
                let diagnostic = did_you_mean(Code::UnknownMember, at, &message, near).note(MEMBERS_NOTE);
                self.refuse_with(diagnostic, at)
            }
        }
    }

    /// The element of an input for a channel.
    pub(super) fn of_channel(&mut self, input: Input, channel: u8, at: Place) -> ExprId {
        let array = self.input(VariableKind::Input(input), at);
        let index = self.int_literal(channel.into(), at);
        self.index(array, index, at)
    }

    /// A variable of the prelude.
    pub(super) fn input(&mut self, kind: VariableKind, at: Place) -> ExprId {
        let is_declared = |(_, variable): &(VariableId, &Variable)| variable.kind == kind;
        let declared = self.tree.variables.iter().find(is_declared);
        match declared.map(|(id, variable)| (id, variable.ty)) {
            Some((id, ty)) => self.push(ExprKind::Variable(id), ty, false, at),
            None => self.error_expr(at),
        }
    }

    pub(super) fn int_literal(&mut self, value: i32, at: Place) -> ExprId {
        let literal = Literal::new(value.to_string(), Value::Int(value));
        self.literal(literal, at)
    }
}
