//! Lifting of single operations: each operation of the intermediate representation becomes a few nodes, whose
//! bits are those of its handler.

use toyproof_eval::native::{Kind, NONE, Operation, Predicate, Value, ValueDef};

use super::assemble::Constant;
use super::lift::{Content, Lifter, WordNode};
use super::node::{Action, Item, NO_NODE, Node, NodeId, Precision, long_words, words};
use super::op::{self, Opcode};

// The predicates of comparisons.
const EQUAL: u8 = 0;
const LESS: u8 = 1;
const LESS_EQUAL: u8 = 2;
const UNORDERED: u8 = 3;
const NOT_EQUAL: u8 = 4;

// The rounding modes of `vroundps` and `vroundpd`. The bit 8 suppresses the precision exception.
const TO_EVEN: u8 = 8;
const DOWN: u8 = 8 | 1;
const UP: u8 = 8 | 2;
const TOWARD_ZERO: u8 = 8 | 3;

impl Lifter<'_> {
    // Nodes.

    pub(super) fn node(&mut self, action: Action, operands: [NodeId; 3], wide: bool) -> NodeId {
        let id = self.region.nodes.len() as NodeId;
        let node = Node {
            action,
            operands,
            wide: wide && !self.scalar,
        };
        self.region.nodes.push(node);
        if !node.is_lazy() {
            self.region.items.push(Item::Compute(id));
        }
        id
    }

    pub(super) fn constant(&mut self, constant: Constant) -> NodeId {
        let number = self.pool.number(constant);
        self.node(Action::Constant(number), [NO_NODE; 3], true)
    }

    /// Whether vectors of words are wide.
    pub(super) fn words_are_wide(&self) -> bool {
        !self.precision.is_double()
    }

    fn float1(&mut self, opcodes: [Opcode; 2], a: NodeId) -> NodeId {
        let opcode = self.by_precision(opcodes);
        self.node(Action::Unary(opcode), [a, NO_NODE, NO_NODE], true)
    }

    fn float2(&mut self, opcodes: [Opcode; 2], a: NodeId, b: NodeId) -> NodeId {
        let opcode = self.by_precision(opcodes);
        self.node(Action::Binary(opcode), [a, b, NO_NODE], true)
    }

    /// An operation on bits of floats.
    fn bits2(&mut self, opcode: Opcode, a: NodeId, b: NodeId) -> NodeId {
        self.node(Action::Binary(opcode), [a, b, NO_NODE], true)
    }

    pub(super) fn word2(&mut self, opcode: Opcode, a: NodeId, b: NodeId) -> NodeId {
        let wide = self.words_are_wide();
        self.node(Action::Binary(opcode), [a, b, NO_NODE], wide)
    }

    /// A comparison of floats, in lanes as wide as theirs.
    fn compare_lanes(&mut self, predicate: u8, a: NodeId, b: NodeId) -> NodeId {
        let opcode = self.by_precision([op::VCMPPS, op::VCMPPD]);
        self.node(Action::BinaryImmediate(opcode, predicate), [a, b, NO_NODE], true)
    }

    fn compare(&mut self, predicate: u8, a: NodeId, b: NodeId) -> WordNode {
        let node = self.compare_lanes(predicate, a, b);
        self.lanes(node)
    }

    /// A word of lanes as wide as those of floats.
    fn lanes(&self, node: NodeId) -> WordNode {
        self.by_precision([WordNode::Narrow(node), WordNode::Wide(node)])
    }

    pub(super) fn blend(&mut self, mask: NodeId, yes: NodeId, no: NodeId) -> NodeId {
        let opcode = self.by_precision([op::VBLENDVPS, op::VBLENDVPD]);
        self.node(Action::Blend(opcode), [no, yes, mask], true)
    }

    pub(super) fn blend_words(&mut self, mask: NodeId, yes: NodeId, no: NodeId) -> NodeId {
        let wide = self.words_are_wide();
        self.node(Action::Blend(op::VBLENDVPS), [no, yes, mask], wide)
    }

    /// Flushes denormals, if the processor does not.
    fn flush(&mut self, a: NodeId) -> NodeId {
        if self.precision != Precision::SingleExact {
            return a;
        }
        let exponent = self.constant(words(0x7F80_0000));
        let zero = self.constant(words(0));
        let exponent = self.bits2(op::VPAND, a, exponent);
        let tiny = self.bits2(op::VPCMPEQD, exponent, zero);
        let magnitude = self.node(Action::ShiftRight(1), [tiny, NO_NODE, NO_NODE], true);
        self.bits2(op::VPANDN, magnitude, a)
    }

    fn sum(&mut self, a: NodeId, b: NodeId) -> NodeId {
        let sum = self.float2([op::VADDPS, op::VADDPD], a, b);
        self.flush(sum)
    }

    fn difference(&mut self, a: NodeId, b: NodeId) -> NodeId {
        let difference = self.float2([op::VSUBPS, op::VSUBPD], a, b);
        self.flush(difference)
    }

    fn product(&mut self, a: NodeId, b: NodeId) -> NodeId {
        let product = self.float2([op::VMULPS, op::VMULPD], a, b);
        self.flush(product)
    }

    fn sign(&mut self) -> NodeId {
        self.bits(1 << 31, 1 << 63)
    }

    fn absolute(&mut self, a: NodeId) -> NodeId {
        let magnitude = self.bits(!(1 << 31), !(1 << 63));
        self.bits2(op::VPAND, a, magnitude)
    }

    /// A constant float in all lanes.
    pub(super) fn float(&mut self, value: f64) -> NodeId {
        self.bits((value as f32).to_bits(), value.to_bits())
    }

    /// The bits of a float in all lanes.
    fn bits(&mut self, single: u32, double: u64) -> NodeId {
        self.constant(self.by_precision([words(single), long_words(double)]))
    }

    /// Selects what is for 32 bits or for 64.
    fn by_precision<T: Copy>(&self, [single, double]: [T; 2]) -> T {
        if self.precision.is_double() {
            double
        } else {
            single
        }
    }

    // Words in both forms.

    pub(super) fn narrow(&mut self, word: WordNode) -> NodeId {
        match word {
            WordNode::Narrow(node) => node,
            WordNode::Wide(node) => self.converted.get(node).unwrap_or_else(|| {
                let narrow = self.node(Action::Narrow, [node, NO_NODE, NO_NODE], true);
                self.region.nodes[narrow as usize].wide = false;
                self.converted.set(node, Some(narrow));
                self.converted.set(narrow, Some(node));
                narrow
            }),
        }
    }

    /// Returns a word in lanes as wide as those of floats.
    pub(super) fn as_lanes(&mut self, word: WordNode) -> NodeId {
        match word {
            WordNode::Narrow(node) if !self.precision.is_double() || self.is_ones(word) => node,
            WordNode::Wide(node) => node,
            WordNode::Narrow(node) => self.converted.get(node).unwrap_or_else(|| {
                let wide = self.node(Action::Unary(op::VPMOVSXDQ), [node, NO_NODE, NO_NODE], true);
                self.converted.set(node, Some(wide));
                self.converted.set(wide, Some(node));
                wide
            }),
        }
    }

    /// Whether all bits of a word are set, in any lanes.
    fn is_ones(&self, word: WordNode) -> bool {
        let (WordNode::Narrow(node) | WordNode::Wide(node)) = word;
        match self.region.nodes[node as usize].action {
            Action::Constant(number) => self.pool.constants[number as usize] == words(u32::MAX),
            _ => false,
        }
    }

    /// Whether a word exists in wide lanes.
    pub(super) fn has_wide(&self, word: WordNode) -> bool {
        match word {
            WordNode::Wide(_) => true,
            WordNode::Narrow(node) => self.converted.get(node).is_some(),
        }
    }

    /// An operation on bits, in the form that the operands have.
    pub(super) fn logic(&mut self, opcode: Opcode, a: WordNode, b: WordNode) -> WordNode {
        if opcode == op::VPAND && self.is_ones(b) {
            return a;
        }
        if self.precision.is_double() && (self.has_wide(a) || self.has_wide(b)) {
            let [a, b] = [self.as_lanes(a), self.as_lanes(b)];
            return WordNode::Wide(self.bits2(opcode, a, b));
        }
        let [a, b] = [self.narrow(a), self.narrow(b)];
        WordNode::Narrow(self.word2(opcode, a, b))
    }

    pub(super) fn not(&mut self, a: WordNode) -> WordNode {
        let ones = self.constant(words(u32::MAX));
        match a {
            WordNode::Wide(node) => WordNode::Wide(self.bits2(op::VPXOR, node, ones)),
            WordNode::Narrow(node) => WordNode::Narrow(self.word2(op::VPXOR, node, ones)),
        }
    }

    /// Lifts a predicate: the pixels for which it holds.
    pub(super) fn predicate(&mut self, predicate: Predicate, [first, second]: [Value; 2]) -> WordNode {
        let second = if second == NONE { first } else { second };
        match predicate {
            Predicate::AtLeast(limit) => {
                let a = self.word_value(first);
                let a = self.narrow(a);
                let limit = self.constant(words(limit));
                let larger = self.word2(op::VPMAXUD, a, limit);
                return WordNode::Narrow(self.word2(op::VPCMPEQD, larger, a));
            }
            Predicate::Zero => {
                let a = self.word_value(first);
                let a = self.narrow(a);
                let zero = self.constant(words(0));
                return WordNode::Narrow(self.word2(op::VPCMPEQD, a, zero));
            }
            _ => {}
        }
        let [a, b] = [first, second].map(|value| self.float_value(value));
        let zero = self.float(0.0);
        match predicate {
            Predicate::NotInt => {
                let (low, whole) = (self.float(-2_147_483_648.0), self.round(a, TOWARD_ZERO));
                let is_above = self.compare(LESS_EQUAL, low, whole);
                self.is_outside(a, is_above, 2_147_483_648.0)
            }
            Predicate::NotUint => {
                let low = self.float(-1.0);
                let is_above = self.compare(LESS, low, a);
                self.is_outside(a, is_above, 4_294_967_296.0)
            }
            Predicate::Unordered => self.compare(UNORDERED, a, b),
            Predicate::Equal => self.compare(EQUAL, a, b),
            Predicate::Greater => self.compare(LESS, b, a),
            Predicate::Negative => self.compare(LESS, a, zero),
            Predicate::NotPositive => self.compare(LESS_EQUAL, a, zero),
            Predicate::BeyondOne => {
                let [size, one] = [self.absolute(a), self.float(1.0)];
                self.compare(LESS, one, size)
            }
            Predicate::AtLeastOne => {
                let [size, one] = [self.absolute(a), self.float(1.0)];
                self.compare(LESS_EQUAL, one, size)
            }
            Predicate::BelowOne => {
                let one = self.float(1.0);
                self.compare(LESS, a, one)
            }
            Predicate::PowUndefined => {
                let negative = self.compare(LESS, a, zero);
                let is_zero = self.compare(EQUAL, a, zero);
                let not_positive = self.compare(LESS_EQUAL, b, zero);
                let both = self.logic(op::VPAND, is_zero, not_positive);
                self.logic(op::VPOR, negative, both)
            }
            // BothZero and ConstantZeros; the others are above, or have no vector form.
            _ => {
                let [a, b] = [a, b].map(|value| self.compare(EQUAL, value, zero));
                self.logic(op::VPAND, a, b)
            }
        }
    }

    /// Whether a float is out of a range; `is_above` is whether it is above the lower limit.
    fn is_outside(&mut self, a: NodeId, is_above: WordNode, limit: f64) -> WordNode {
        let limit = self.float(limit);
        let is_below = self.compare(LESS, a, limit);
        let is_inside = self.logic(op::VPAND, is_above, is_below);
        self.not(is_inside)
    }

    pub(super) fn operation(&mut self, operation: Operation, operands: [Value; 3]) -> Content {
        let mut floats = [NO_NODE; 3];
        let mut words_of = [WordNode::Narrow(NO_NODE); 3];
        for (at, kind) in operation.operands().iter().enumerate() {
            match kind {
                Kind::Float => floats[at] = self.float_value(operands[at]),
                Kind::Word => words_of[at] = self.word_value(operands[at]),
            }
        }
        let is_shift = matches!(
            operation,
            Operation::ShiftLeft | Operation::ShiftRightInt | Operation::ShiftRightUint
        );
        if is_shift && let ValueDef::Word(count) = self.lowered.function.def(operands[1]) {
            words_of[1] = WordNode::Narrow(self.constant(words(count & 31)));
        }
        match self.float_operation(operation, floats, words_of[0]) {
            Some(float) => Content::Float(float),
            None => Content::Word(self.word_result(operation, floats, words_of)),
        }
    }

    /// Lifts an operation whose result is a float; none for others.
    fn float_operation(
        &mut self,
        operation: Operation,
        [a, b, c]: [NodeId; 3],
        u: WordNode,
    ) -> Option<NodeId> {
        use Operation as O;
        Some(match operation {
            O::Add => self.sum(a, b),
            O::Sub => self.difference(a, b),
            O::Mul => self.product(a, b),
            O::Div => {
                let quotient = self.float2([op::VDIVPS, op::VDIVPD], a, b);
                self.flush(quotient)
            }
            O::MulAdd => {
                let product = self.product(a, b);
                self.sum(product, c)
            }
            O::MulSub => {
                let product = self.product(a, b);
                self.difference(product, c)
            }
            O::SubMul => {
                let product = self.product(a, b);
                self.difference(c, product)
            }
            // The instruction returns its second operand for zeros and for NaN.
            O::Min | O::Max => {
                let opcodes = if operation == O::Min {
                    [op::VMINPS, op::VMINPD]
                } else {
                    [op::VMAXPS, op::VMAXPD]
                };
                let chosen = self.float2(opcodes, a, b);
                let is_nan = self.compare_lanes(UNORDERED, b, b);
                self.blend(is_nan, a, chosen)
            }
            O::Neg => {
                let sign = self.sign();
                self.bits2(op::VPXOR, a, sign)
            }
            O::Abs => self.absolute(a),
            O::Sqrt => self.float1([op::VSQRTPS, op::VSQRTPD], a),
            O::Floor => self.round(a, DOWN),
            O::Ceil => self.round(a, UP),
            O::Trunc => self.round(a, TOWARD_ZERO),
            O::RoundEven => self.round(a, TO_EVEN),
            O::Select => {
                let mask = self.as_lanes(u);
                self.blend(mask, b, c)
            }
            O::FromInt => {
                let u = self.narrow(u);
                self.float1([op::VCVTDQ2PS, op::VCVTDQ2PD], u)
            }
            O::FromUint => {
                let u = self.narrow(u);
                self.float_of_uint(u)
            }
            O::FromBits => {
                let u = self.narrow(u);
                if self.precision.is_double() {
                    self.float1([op::VCVTPS2PD; 2], u)
                } else {
                    u
                }
            }
            O::DFdx => self.derivative(a, [0xF5, 0xA0]),
            O::DFdy => self.derivative(a, [0xEE, 0x44]),
            _ => return None,
        })
    }

    /// Lifts an operation whose result is a word.
    fn word_result(
        &mut self,
        operation: Operation,
        [a, b, _]: [NodeId; 3],
        [u, v, w]: [WordNode; 3],
    ) -> WordNode {
        use Operation as O;
        match operation {
            O::Less => self.compare(LESS, a, b),
            O::LessEqual => self.compare(LESS_EQUAL, a, b),
            O::Equal => self.compare(EQUAL, a, b),
            O::NotEqual => self.compare(NOT_EQUAL, a, b),
            O::IsNan => self.compare(UNORDERED, a, a),
            O::IsInf => {
                let size = self.absolute(a);
                let infinity = self.float(f64::INFINITY);
                self.compare(EQUAL, size, infinity)
            }
            O::ToInt => self.int_of(a),
            O::ToUint => self.uint_of(a),
            O::ToBits => {
                if self.precision.is_double() {
                    let single = self.node(Action::Unary(op::VCVTPD2PS), [a, NO_NODE, NO_NODE], true);
                    WordNode::Narrow(single)
                } else {
                    WordNode::Narrow(a)
                }
            }
            O::And => self.logic(op::VPAND, u, v),
            O::Or => self.logic(op::VPOR, u, v),
            O::Xor => self.logic(op::VPXOR, u, v),
            O::Not => self.not(u),
            O::SelectWord => {
                let [u, v, w] = [u, v, w].map(|word| self.narrow(word));
                WordNode::Narrow(self.blend_words(u, v, w))
            }
            _ => {
                let u = self.narrow(u);
                let v = if operation.operands().len() > 1 {
                    self.narrow(v)
                } else {
                    NO_NODE
                };
                WordNode::Narrow(self.word_operation(operation, u, v))
            }
        }
    }

    fn word_operation(&mut self, operation: Operation, u: NodeId, v: NodeId) -> NodeId {
        use Operation as O;
        match operation {
            O::AddWord => self.word2(op::VPADDD, u, v),
            O::SubWord => self.word2(op::VPSUBD, u, v),
            O::MulWord => self.word2(op::VPMULLD, u, v),
            O::NegWord => {
                let zero = self.constant(words(0));
                self.word2(op::VPSUBD, zero, u)
            }
            O::ShiftLeft => self.shift(op::VPSLLVD, u, v),
            O::ShiftRightInt => self.shift(op::VPSRAVD, u, v),
            O::ShiftRightUint => self.shift(op::VPSRLVD, u, v),
            O::MinInt => self.word2(op::VPMINSD, u, v),
            O::MaxInt => self.word2(op::VPMAXSD, u, v),
            O::MinUint => self.word2(op::VPMINUD, u, v),
            O::MaxUint => self.word2(op::VPMAXUD, u, v),
            O::EqualWord => self.word2(op::VPCMPEQD, u, v),
            O::LessInt => self.word2(op::VPCMPGTD, v, u),
            // LessUint: not at least.
            _ => {
                let larger = self.word2(op::VPMAXUD, u, v);
                let at_least = self.word2(op::VPCMPEQD, larger, u);
                let not = self.not(WordNode::Narrow(at_least));
                self.narrow(not)
            }
        }
    }

    /// A shift by the lowest five bits of a word.
    pub(super) fn shift(&mut self, opcode: Opcode, u: NodeId, v: NodeId) -> NodeId {
        // Constants are below 32.
        if matches!(self.region.nodes[v as usize].action, Action::Constant(_)) {
            return self.word2(opcode, u, v);
        }
        let bits = self.constant(words(31));
        let count = self.word2(op::VPAND, v, bits);
        self.word2(opcode, u, count)
    }

    fn round(&mut self, a: NodeId, mode: u8) -> NodeId {
        let opcode = self.by_precision([op::VROUNDPS, op::VROUNDPD]);
        self.node(Action::UnaryImmediate(opcode, mode), [a, NO_NODE, NO_NODE], true)
    }

    /// Differences of the lanes that two permutations of a quad select.
    fn derivative(&mut self, a: NodeId, lanes: [u8; 2]) -> NodeId {
        let opcode = self.by_precision([op::VPERMILPS, op::VPERMPD]);
        let [to, from] =
            lanes.map(|lanes| self.node(Action::UnaryImmediate(opcode, lanes), [a, NO_NODE, NO_NODE], true));
        self.difference(to, from)
    }

    /// Rounds toward zero; too large floats and NaN give the largest f32 that fits.
    fn int_of(&mut self, a: NodeId) -> WordNode {
        let limit = self.float(2_147_483_648.0);
        let fits = self.compare(LESS, a, limit);
        let fits = self.narrow(fits);
        let opcode = self.by_precision([op::VCVTTPS2DQ, op::VCVTTPD2DQ]);
        let converted = self.node(Action::Unary(opcode), [a, NO_NODE, NO_NODE], true);
        let largest = self.constant(words(2_147_483_520));
        WordNode::Narrow(self.blend_words(fits, converted, largest))
    }

    /// Converts a word without a sign; rounded once.
    fn float_of_uint(&mut self, u: NodeId) -> NodeId {
        let opcodes = [op::VCVTDQ2PS, op::VCVTDQ2PD];
        if self.precision.is_double() {
            let sign = self.constant(words(1 << 31));
            let moved = self.word2(op::VPXOR, u, sign);
            let float = self.float1(opcodes, moved);
            let half = self.float(2_147_483_648.0);
            return self.float2([op::VADDPS, op::VADDPD], float, half);
        }
        let high = self.node(Action::ShiftRight(16), [u, NO_NODE, NO_NODE], true);
        let mask = self.constant(words(0xFFFF));
        let low = self.word2(op::VPAND, u, mask);
        let [high, low] = [high, low].map(|part| self.float1(opcodes, part));
        let factor = self.float(65_536.0);
        let high = self.float2([op::VMULPS, op::VMULPD], high, factor);
        self.float2([op::VADDPS, op::VADDPD], high, low)
    }

    /// Rounds toward zero; negative floats give 0, too large ones and NaN the largest f32 that fits.
    fn uint_of(&mut self, a: NodeId) -> WordNode {
        let half = self.float(2_147_483_648.0);
        let is_large = self.compare_lanes(LESS_EQUAL, half, a);
        let less = self.float2([op::VSUBPS, op::VSUBPD], a, half);
        let part = self.blend(is_large, less, a);
        let zero = self.float(0.0);
        let part = self.float2([op::VMAXPS, op::VMAXPD], part, zero);
        let opcode = self.by_precision([op::VCVTTPS2DQ, op::VCVTTPD2DQ]);
        let converted = self.node(Action::Unary(opcode), [part, NO_NODE, NO_NODE], true);
        let is_large = self.lanes(is_large);
        let is_large = self.narrow(is_large);
        let sign = self.constant(words(1 << 31));
        let high = self.word2(op::VPAND, is_large, sign);
        let converted = self.word2(op::VPXOR, converted, high);
        let limit = self.float(4_294_967_296.0);
        let fits = self.compare(LESS, a, limit);
        let fits = self.narrow(fits);
        let largest = self.constant(words(4_294_967_040));
        WordNode::Narrow(self.blend_words(fits, converted, largest))
    }
}
