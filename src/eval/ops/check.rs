//! Notes of undefined operations: cheap where there are none.

use super::{Handler, Instruction, Level, One, Row, Run, Source, for_each_chunk, handler};
use crate::batch::{Batch, LANES, any};
use crate::number::Number;
use crate::observe::{Predicate, SiteId};

/// Says of one or two operands whether they are at fault.
trait Holds<N: Number, T> {
    fn holds(a: T, b: T, limit: u32) -> bool;
}

macro_rules! holds {
    ($($name:ident($a:ident, $b:ident, $limit:ident: $ty:ty) = $value:expr;)*) => {$(
        struct $name;
        impl<N: Number> Holds<N, $ty> for $name {
            #[inline(always)]
            fn holds($a: $ty, $b: $ty, $limit: u32) -> bool {
                $value
            }
        }
    )*};
}

holds! {
    From(a, _b, limit: u32) = a >= limit;
    Zero(a, _b, _limit: u32) = a == 0;
    NoInt(a, _b, _limit: N) = !(a > N::from_f64(-2_147_483_649.0) && a < N::from_f64(2_147_483_648.0));
    NoUint(a, _b, _limit: N) = !(a > N::from_f64(-1.0) && a < N::from_f64(4_294_967_296.0));
    Unordered(a, b, _limit: N) = a.is_nan() || b.is_nan();
    Equal(a, b, _limit: N) = a == b;
    Greater(a, b, _limit: N) = a > b;
    Negative(a, _b, _limit: N) = a < N::default();
    NotPositive(a, _b, _limit: N) = a <= N::default();
    BeyondOne(a, _b, _limit: N) = a.abs() > N::from_f64(1.0);
    FromOne(a, _b, _limit: N) = a.abs() >= N::from_f64(1.0);
    BelowOne(a, _b, _limit: N) = a < N::from_f64(1.0);
    BothZero(a, b, _limit: N) = a == N::default() && b == N::default();
    NoPower(a, b, _limit: N) = a < N::default() || (a == N::default() && b <= N::default());
}

/// Looks at the pixels that are here. `out` is the site, `to` the predicate's limit.
struct Check<P, A, B, T>(std::marker::PhantomData<(P, A, B, T)>);

impl<N: Number, P: Holds<N, T>, A: Source<N, T>, B: Source<N, T>, T: Copy> Run<N> for Check<P, A, B, T> {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let a = A::open(batch, instruction.operands[0]);
        let b = B::open(batch, instruction.operands[1]);
        let mask = batch.mask_row(instruction.mask);
        for_each_chunk!(batch, instruction.mask, chunk => {
            let (a, b, mask) = (A::chunk(a, chunk), B::chunk(b, chunk), mask[chunk].get());
            let mut hit = [0; LANES];
            for lane in 0..LANES {
                hit[lane] = mask[lane] & u32::from(P::holds(a[lane], b[lane], instruction.to)).wrapping_neg();
            }
            if any(&hit) {
                batch.notes.borrow_mut().add(SiteId(instruction.out), chunk, &hit);
            }
        });
        at + 1
    }
}

/// Looks for quads of which some pixels are here and some are not.
struct Lonely;

impl<N: Number> Run<N> for Lonely {
    #[inline(always)]
    fn run(batch: &Batch<'_, N>, instruction: &Instruction<N>, at: usize) -> usize {
        let here = batch.here[instruction.mask as usize].get();
        if here.all {
            return at + 1;
        }
        let mask = batch.mask_row(instruction.mask);
        for_each_chunk!(batch, instruction.mask, chunk => {
            let mask = mask[chunk].get();
            let mut hit = [0; LANES];
            for (hit, quad) in hit.chunks_exact_mut(4).zip(mask.chunks_exact(4)) {
                if quad.contains(&0) {
                    hit.copy_from_slice(quad);
                }
            }
            if hit != [0; LANES] {
                batch.notes.borrow_mut().add(SiteId(instruction.out), chunk, &hit);
            }
        });
        at + 1
    }
}

/// The handler of a check whose operands are rows or not.
pub(crate) fn check<N: Number>(level: Level, predicate: Predicate, rows: [bool; 2]) -> Handler<N> {
    macro_rules! forms {
        ($name:ident, $ty:ty) => {
            match rows {
                [true, true] => handler::<N, Check<$name, Row, Row, $ty>>(level),
                [true, false] => handler::<N, Check<$name, Row, One, $ty>>(level),
                [false, true] => handler::<N, Check<$name, One, Row, $ty>>(level),
                [false, false] => handler::<N, Check<$name, One, One, $ty>>(level),
            }
        };
    }
    match predicate {
        Predicate::From(_) => forms!(From, u32),
        Predicate::Zero => forms!(Zero, u32),
        Predicate::NoInt => forms!(NoInt, N),
        Predicate::NoUint => forms!(NoUint, N),
        Predicate::Unordered => forms!(Unordered, N),
        Predicate::Equal => forms!(Equal, N),
        Predicate::Greater => forms!(Greater, N),
        Predicate::Negative => forms!(Negative, N),
        Predicate::NotPositive => forms!(NotPositive, N),
        Predicate::BeyondOne => forms!(BeyondOne, N),
        Predicate::FromOne => forms!(FromOne, N),
        Predicate::BelowOne => forms!(BelowOne, N),
        Predicate::BothZero | Predicate::ConstantZeros => forms!(BothZero, N),
        Predicate::NoPower => forms!(NoPower, N),
        Predicate::Lonely => handler::<N, Lonely>(level),
    }
}
