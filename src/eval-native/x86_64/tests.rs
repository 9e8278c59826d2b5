//! Tests of the assembler: a disassembler reads each form of each instruction as what was to be emitted. That
//! machine code has the bits of the handlers is tested with whole programs, by the suite.

use iced_x86::{
    Code, Decoder, DecoderOptions, Formatter, Instruction, MemorySizeOptions, Mnemonic, NasmFormatter,
    NumberBase,
};

use super::assemble::{
    Arithmetic, Assembler, Condition, Gpr, Memory, RAX, RBP, RBX, RCX, RSP, Source, Vectors,
};
use super::op;

const GPRS: [&str; 16] = [
    "rax", "rcx", "rdx", "rbx", "rsp", "rbp", "rsi", "rdi", "r8", "r9", "r10", "r11", "r12", "r13", "r14",
    "r15",
];
const GPRS32: [&str; 16] = [
    "eax", "ecx", "edx", "ebx", "esp", "ebp", "esi", "edi", "r8d", "r9d", "r10d", "r11d", "r12d", "r13d",
    "r14d", "r15d",
];

/// Opcodes with their names.
macro_rules! opcodes {
    ($($name:ident)*) => {
        [$((stringify!($name).to_lowercase(), op::$name)),*]
    };
}

/// Decodes what a function emits.
fn decode(vectors: Vectors, emit: &dyn Fn(&mut Assembler)) -> Vec<Instruction> {
    let mut code = Assembler::new(vectors);
    emit(&mut code);
    let length = code.len();
    let bytes = code.finish(&[]);
    let mut decoder = Decoder::new(64, &bytes[..length], DecoderOptions::NONE);
    let instructions: Vec<_> = decoder.iter().collect();
    assert!(
        instructions
            .iter()
            .all(|instruction| instruction.code() != Code::INVALID),
        "{:x?}",
        &bytes[..length]
    );
    instructions
}

/// Checks that a function emits these instructions.
#[track_caller]
fn check(vectors: Vectors, expected: &str, emit: &dyn Fn(&mut Assembler)) {
    let mut formatter = NasmFormatter::new();
    let options = formatter.options_mut();
    options.set_number_base(NumberBase::Decimal);
    options.set_memory_size_options(MemorySizeOptions::Always);
    options.set_use_pseudo_ops(false);
    options.set_signed_immediate_operands(true);
    let texts = decode(vectors, emit).into_iter().map(|instruction| {
        let mut text = String::new();
        formatter.format(&instruction, &mut text);
        text
    });
    assert_eq!(texts.collect::<Vec<_>>().join("; "), expected);
}

/// Memory operands with all registers and all lengths of displacements, and their texts.
fn memories() -> Vec<(Memory, String)> {
    let registers = || (0..16).map(Gpr);
    let without = registers().map(|base| (base, None));
    let with = registers().flat_map(|base| {
        let indices = registers().filter(|&index| index != RSP);
        indices.map(move |index| (base, Some((index, index.0 % 4))))
    });
    let mut memories = Vec::new();
    for (base, index) in without.chain(with) {
        for displacement in [0, 8, 127, 128, 4096, -1, -128, -129] {
            let memory = Memory::At {
                base,
                index,
                displacement,
            };
            let name = |register: Gpr| GPRS[usize::from(register.0)];
            let index = match index {
                None => String::new(),
                Some((index, 0)) => format!("+{}", name(index)),
                Some((index, scale)) => format!("+{}*{}", name(index), 1 << scale),
            };
            let displacement = match displacement {
                0 => String::new(),
                _ => format!("{displacement:+}"),
            };
            memories.push((memory, format!("[{}{index}{displacement}]", name(base))));
        }
    }
    memories
}

/// The registers of a number of bits.
fn vector(bits: u32, number: u8) -> String {
    let letter = match bits {
        512 => 'z',
        256 => 'y',
        _ => 'x',
    };
    format!("{letter}mm{number}")
}

/// The keyword of a memory operand of a number of bits.
fn keyword(bits: u32) -> &'static str {
    match bits {
        512 => "zword",
        256 => "yword",
        128 => "oword",
        64 => "qword",
        _ => "dword",
    }
}

/// All vectors that instructions are emitted for: their kind, whether they are wide, and their bits.
const FORMS: [(Vectors, bool, u32); 4] = [
    (Vectors::Avx2, false, 128),
    (Vectors::Avx2, true, 256),
    (Vectors::Avx512, false, 256),
    (Vectors::Avx512, true, 512),
];

/// Checks that a method of the assembler emits the instructions of a text.
macro_rules! emits {
    ($vectors:expr, $text:literal => $method:ident($($argument:expr),*)) => {
        check($vectors, &format!($text), &|code| code.$method($($argument),*))
    };
}

/// Calls a function with registers for two operands, and sources of a number of bits for a third one: all
/// pairs of registers, and all memory operands.
fn for_each_source(bits: u32, mut work: impl FnMut(u8, u8, Source, &str)) {
    for (to, a) in (0..16).flat_map(|to| (0..16).map(move |a| (to, a))) {
        let b = (to + a) % 16;
        work(to, a, Source::Register(b), &vector(bits, b));
    }
    for (at, (memory, text)) in (0..).zip(memories()) {
        let text = format!("{} {text}", keyword(bits));
        work(at % 16, at / 16 % 16, Source::Memory(memory), &text);
    }
}

#[test]
fn instructions_with_one_operand() {
    // How many halves of a vector the result and the operand take.
    let same = opcodes![VMOVAPS VMOVUPS VSQRTPS VSQRTPD VCVTDQ2PS VCVTTPS2DQ].map(|named| (named, 2, 2));
    let longer = opcodes![VCVTDQ2PD VCVTPS2PD VPMOVSXDQ].map(|named| (named, 2, 1));
    let shorter = opcodes![VCVTTPD2DQ VCVTPD2PS].map(|named| (named, 1, 2));
    let table: Vec<_> = same.into_iter().chain(longer).chain(shorter).collect();
    for (vectors, wide, bits) in FORMS {
        for ((name, opcode), to_halves, from_halves) in &table {
            for_each_source(bits / 2 * from_halves, |to, _, source, text| {
                let to_name = vector(bits / 2 * to_halves, to);
                emits!(vectors, "{name} {to_name},{text}" => unary(*opcode, wide, to, source));
            });
        }
    }
}

#[test]
fn loads_and_stores() {
    for (at, (memory, text)) in (0..).zip(memories()) {
        let (register, memory) = (at % 16, Source::Memory(memory));
        for (vectors, wide, bits) in FORMS {
            let (name, size) = (vector(bits, register), keyword(bits));
            emits!(vectors, "vmovaps {size} {text},{name}"
                => unary(op::VMOVAPS_STORE, wide, register, memory));
            emits!(vectors, "vmovups {size} {text},{name}"
                => unary(op::VMOVUPS_STORE, wide, register, memory));
            emits!(vectors, "vbroadcastss {name},dword {text}"
                => unary(op::VBROADCASTSS, wide, register, memory));
            if bits > 128 {
                emits!(vectors, "vbroadcastsd {name},qword {text}"
                    => unary(op::VBROADCASTSD, wide, register, memory));
            }
        }
        for vectors in [Vectors::Avx2, Vectors::Avx512] {
            let name = vector(128, register);
            emits!(vectors, "vmovss {name},dword {text}" => unary(op::VMOVSS, false, register, memory));
            emits!(vectors, "vmovss dword {text},{name}" => unary(op::VMOVSS_STORE, false, register, memory));
            emits!(vectors, "vmovsd {name},qword {text}" => unary(op::VMOVSD, false, register, memory));
            emits!(vectors, "vmovsd qword {text},{name}" => unary(op::VMOVSD_STORE, false, register, memory));
        }
    }
}

#[test]
fn instructions_with_two_operands() {
    let table = opcodes![
        VADDPS VADDPD VSUBPS VSUBPD VMULPS VMULPD VDIVPS VDIVPD VMINPS VMINPD VMAXPS VMAXPD VPAND VPANDN VPOR
        VPXOR VPADDD VPSUBD VPMULLD VPCMPEQD VPCMPGTD VPMINSD VPMINUD VPMAXSD VPMAXUD VPSLLVD VPSRLVD VPSRAVD
    ];
    for (vectors, wide, bits) in FORMS {
        for (name, opcode) in &table {
            for_each_source(bits, |to, a, b, text| {
                let [to_name, a_name] = [to, a].map(|number| vector(bits, number));
                let (suffix, to_name, spread) = match name.as_str() {
                    "vpand" | "vpandn" | "vpor" | "vpxor" if bits == 512 => ("d", to_name, String::new()),
                    "vpcmpeqd" | "vpcmpgtd" if bits == 512 => {
                        ("", "k1".into(), format!("; vpmovm2d {to_name},k1"))
                    }
                    _ => ("", to_name, String::new()),
                };
                emits!(vectors, "{name}{suffix} {to_name},{a_name},{text}{spread}"
                    => binary(*opcode, wide, to, a, b));
            });
        }
    }
}

#[test]
fn instructions_with_immediates() {
    for (vectors, wide, bits) in FORMS {
        let round = if bits == 512 { "vrndscale" } else { "vround" };
        for_each_source(bits, |to, a, b, text| {
            let [name, first] = [to, a].map(|number| vector(bits, number));
            for how in 8..12 {
                emits!(vectors, "{round}ps {name},{text},{how}"
                    => unary_immediate(op::VROUNDPS, wide, to, b, how));
                emits!(vectors, "{round}pd {name},{text},{how}"
                    => unary_immediate(op::VROUNDPD, wide, to, b, how));
            }
            emits!(vectors, "vpermilps {name},{text},78" => unary_immediate(op::VPERMILPS, wide, to, b, 78));
            // It moves lanes of at least 256 bits.
            if wide {
                emits!(vectors, "vpermpd {name},{text},78" => unary_immediate(op::VPERMPD, wide, to, b, 78));
            }
            for (lanes, suffix, opcode) in [("ps", 'd', op::VCMPPS), ("pd", 'q', op::VCMPPD)] {
                for how in 0..5 {
                    let (name, spread) = match bits {
                        512 => ("k1", format!("; vpmovm2{suffix} {name},k1")),
                        _ => (name.as_str(), String::new()),
                    };
                    emits!(vectors, "vcmp{lanes} {name},{first},{text},{how}{spread}"
                        => binary_immediate(opcode, wide, to, a, b, how));
                }
            }
        });
        for (to, from) in (0..16).flat_map(|to| (0..16).map(move |from| (to, from))) {
            let [name, from_name] = [to, from].map(|number| vector(bits, number));
            emits!(vectors, "vpsrld {name},{from_name},31" => shift(wide, op::SHIFT_RIGHT, to, from, 31));
            match bits {
                512 => emits!(vectors, "vpmovqd ymm{to},zmm{from}" => narrow(to, from, 15)),
                _ => emits!(
                    Vectors::Avx2,
                    "vextracti128 xmm15,ymm{from},1; vshufps xmm{to},xmm{from},xmm15,-120" => narrow(to, from, 15)
                ),
            }
            match bits {
                512 => emits!(vectors, "vptestmd k1,{name},{name}; kortestw k1,k1" => test(wide, to)),
                _ => emits!(vectors, "vptest {name},{name}" => test(wide, to)),
            }
        }
    }
}

#[test]
fn blends() {
    for (vectors, wide, bits) in FORMS.into_iter().filter(|(.., bits)| *bits < 512) {
        for mask in 0..16 {
            let mask_name = vector(bits, mask);
            for_each_source(bits, |to, no, yes, text| {
                let [name, first] = [to, no].map(|number| vector(bits, number));
                emits!(vectors, "vblendvps {name},{first},{text},{mask_name}"
                    => blend(op::VBLENDVPS, wide, to, no, yes, mask));
                emits!(vectors, "vblendvpd {name},{first},{text},{mask_name}"
                    => blend(op::VBLENDVPD, wide, to, no, yes, mask));
            });
        }
    }
    emits!(
        Vectors::Avx512,
        "vmovaps zmm9,zmm8; vpternlogd zmm9,zmm13,zword [rbx+32],-72"
            => blend(op::VBLENDVPD, true, 9, 8, Source::Memory(Memory::at(RBX, 32)), 13)
    );
    // Instructions and truth tables depend on which registers are the same, so that they are executed.
    for case in 0..4_u8.pow(4) {
        let [to, no, yes, mask] = [0, 2, 4, 6].map(|shift| case >> shift & 3);
        let instructions = decode(Vectors::Avx512, &|code| {
            code.blend(
                op::VBLENDVPS,
                true,
                to + 9,
                no + 9,
                Source::Register(yes + 9),
                mask + 9,
            );
        });
        for content in 0..16_u8 {
            let mut bits = [0, 1, 2, 3].map(|register| content >> register & 1 != 0);
            let expected = bits[usize::from(if bits[usize::from(mask)] { yes } else { no })];
            for instruction in &instructions {
                let operand = |at| instruction.op_register(at) as usize - iced_x86::Register::ZMM9 as usize;
                bits[operand(0)] = match instruction.mnemonic() {
                    Mnemonic::Vmovaps => bits[operand(1)],
                    Mnemonic::Vpternlogd => {
                        let [a, b, c] = [0, 1, 2].map(|at| u8::from(bits[operand(at)]));
                        instruction.immediate8() >> (4 * a + 2 * b + c) & 1 != 0
                    }
                    other => panic!("{other:?}"),
                };
            }
            assert_eq!(bits[usize::from(to)], expected, "{to} {no} {yes} {mask}");
        }
    }
}

const OPERATIONS: [(&str, Arithmetic); 6] = [
    ("add", Arithmetic::Add),
    ("or", Arithmetic::Or),
    ("and", Arithmetic::And),
    ("sub", Arithmetic::Sub),
    ("xor", Arithmetic::Xor),
    ("cmp", Arithmetic::Compare),
];

const CONDITIONS: [(&str, Condition); 3] = [
    ("b", Condition::Below),
    ("e", Condition::Zero),
    ("ne", Condition::NotZero),
];

#[test]
fn instructions_on_general_purpose_registers() {
    let vectors = Vectors::Avx2;
    for (a, (long, name)) in (0..).zip(GPRS.into_iter().zip(GPRS32)) {
        let a = Gpr(a);
        emits!(vectors, "push {long}" => push(a));
        emits!(vectors, "pop {long}" => pop(a));
        emits!(vectors, "not {name}" => not32(a));
        emits!(vectors, "shl {name},5" => shift_left32(a, 5));
        emits!(vectors, "mov {name},305419896" => immediate32(a, 305_419_896));
        for (mnemonic, operation) in OPERATIONS {
            let source = Source::Register(a.0);
            emits!(vectors, "{mnemonic} {long},-4096" => arithmetic_immediate64(operation, a, -4096));
            emits!(vectors, "{mnemonic} {name},305419896"
                => arithmetic_immediate32(operation, source, 305_419_896));
        }
        for (b, (other_long, other)) in (0..).zip(GPRS.into_iter().zip(GPRS32)) {
            let b = Gpr(b);
            emits!(vectors, "mov {long},{other_long}" => copy64(a, b));
            emits!(vectors, "tzcnt {name},{other}" => lowest_bit32(a, b));
            for (mnemonic, operation) in OPERATIONS {
                emits!(vectors, "{mnemonic} {name},{other}"
                    => arithmetic32(operation, a, Source::Register(b.0)));
            }
            for (suffix, condition) in CONDITIONS {
                emits!(vectors, "cmov{suffix} {name},{other}" => copy_if(condition, a, b));
            }
        }
    }
    for (at, (memory, text)) in (0..).zip(memories()) {
        let (a, source) = (Gpr(at % 16), Source::Memory(memory));
        let (long, name) = (GPRS[usize::from(a.0)], GPRS32[usize::from(a.0)]);
        emits!(vectors, "mov {long},qword {text}" => load64(a, memory));
        emits!(vectors, "mov {name},dword {text}" => load32(a, memory));
        emits!(vectors, "mov qword {text},{long}" => store64(memory, a));
        emits!(vectors, "mov dword {text},{name}" => store32(memory, a));
        emits!(vectors, "mov dword {text},305419896" => store_immediate32(memory, 305_419_896));
        emits!(vectors, "lea {long},{text}" => address(a, memory));
        emits!(vectors, "ldmxcsr dword {text}" => load_mxcsr(memory));
        emits!(vectors, "stmxcsr dword {text}" => store_mxcsr(memory));
        emits!(vectors, "call qword {text}" => call_memory(memory));
        for (mnemonic, operation) in OPERATIONS {
            emits!(vectors, "{mnemonic} {name},dword {text}" => arithmetic32(operation, a, source));
            emits!(vectors, "{mnemonic} dword {text},{name}" => arithmetic_memory32(operation, memory, a));
            emits!(vectors, "{mnemonic} dword {text},305419896"
                => arithmetic_immediate32(operation, source, 305_419_896));
        }
    }
    emits!(vectors, "vzeroupper" => vzeroupper());
    emits!(vectors, "ret" => ret());
}

#[test]
fn addresses_of_labels_and_constants() {
    for vectors in [Vectors::Avx2, Vectors::Avx512] {
        let mut code = Assembler::new(vectors);
        let [before, after] = [(); 2].map(|()| code.label());
        code.bind(before);
        code.jump(after);
        for (_, condition) in CONDITIONS {
            code.jump_if(condition, before);
        }
        code.call(before);
        code.bind(after);
        let end = code.len() as u64;
        let constant = Source::Memory(Memory::Constant(1));
        // One without an immediate operand after the address, and one with.
        code.binary(op::VADDPS, true, 0, 1, constant);
        code.binary_immediate(op::VCMPPS, true, 0, 1, constant, 3);
        let length = code.len();
        let bytes = code.finish(&[[0; 64], [7; 64]]);
        assert_eq!(bytes.len() % 64, 0, "constants are aligned");
        let start = bytes.len() - 64;
        assert_eq!(bytes[start..], [7; 64]);
        let instructions: Vec<_> = Decoder::new(64, &bytes[..length], DecoderOptions::NONE)
            .iter()
            .collect();
        let targets = instructions[..5].iter().map(Instruction::near_branch64);
        assert_eq!(targets.collect::<Vec<_>>(), [end, 0, 0, 0, 0]);
        let mnemonics = instructions[..5].iter().map(Instruction::mnemonic);
        let [jump, call] = [Mnemonic::Jmp, Mnemonic::Call];
        let expected = [jump, Mnemonic::Jb, Mnemonic::Je, Mnemonic::Jne, call];
        assert_eq!(mnemonics.collect::<Vec<_>>(), expected);
        for instruction in &instructions[5..7] {
            assert!(instruction.is_ip_rel_memory_operand());
            assert_eq!(instruction.ip_rel_memory_address(), start as u64);
        }
    }
}

#[test]
fn a_patched_immediate_is_the_last_one() {
    let mut code = Assembler::default();
    code.arithmetic_immediate64(Arithmetic::Sub, RSP, 0);
    let at = code.len() - 4;
    code.arithmetic32(Arithmetic::Or, RAX, Source::Register(RCX.0));
    code.patch(at, 4096);
    code.store64(Memory::at(RBP, 0), RAX);
    let bytes = code.finish(&[]);
    let first = Decoder::new(64, &bytes, DecoderOptions::NONE).decode();
    assert_eq!((first.mnemonic(), first.immediate32to64()), (Mnemonic::Sub, 4096));
}
