//! Several numbers in a register of the processor: what AVX2 and AVX-512 have in common except for
//! the names of their instructions.

/// Makes a type of lanes and its arithmetic. `numbers` and `bits` are the sets of instructions with
/// arithmetic and with operations on bits. To be written out: [`super::Lanes`], and
/// `where_positive`, [`Number::if_positive`](crate::number::Number::if_positive) of the type.
macro_rules! lanes_in_register {
    (
        $(#[$doc:meta])+
        $lanes:ident: $register:ident of $proof:ident,
        numbers: $numbers:ident { sqrt: $sqrt:ident, max: $max:ident, min: $min:ident, },
        operators: { $($operator:ident::$operate:ident: $operation:ident,)+ },
        bits: $bits:ident { xor: $xor:ident, and: $and:ident, or: $or:ident, },
    ) => {
        $(#[$doc])+
        #[derive(Clone, Copy)]
        pub(super) struct $lanes {
            simd: $proof,
            v: $register,
        }

        impl $lanes {
            #[inline(always)]
            fn with(self, v: $register) -> Self {
                Self { simd: self.simd, v }
            }

            #[inline(always)]
            fn constant(self, value: f64) -> Self {
                Self::all(self.simd, value)
            }
        }

        $(impl std::ops::$operator for $lanes {
            type Output = Self;

            #[inline(always)]
            fn $operate(self, other: Self) -> Self {
                self.with(self.simd.$numbers.$operation(self.v, other.v))
            }
        })+

        impl std::ops::Neg for $lanes {
            type Output = Self;

            #[inline(always)]
            fn neg(self) -> Self {
                self.with(self.simd.$bits.$xor(self.v, self.constant(-0.0).v))
            }
        }

        impl crate::number::Number for $lanes {
            #[inline(always)]
            fn zero(self) -> Self {
                self.constant(0.0)
            }

            #[inline(always)]
            fn scale(self, factor: f64) -> Self {
                self * self.constant(factor)
            }

            #[inline(always)]
            fn plus(self, term: f64) -> Self {
                self + self.constant(term)
            }

            #[inline(always)]
            fn inverse(self) -> Self {
                self.constant(1.0) / self
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                self.with(self.simd.$numbers.$sqrt(self.v))
            }

            #[inline(always)]
            fn maximum(self, other: Self) -> Self {
                self.with(self.simd.$numbers.$max(self.v, other.v))
            }

            #[inline(always)]
            fn minimum(self, other: Self) -> Self {
                self.with(self.simd.$numbers.$min(self.v, other.v))
            }

            #[inline(always)]
            fn sign(self) -> Self {
                let sign = self.simd.$bits.$and(self.v, self.constant(-0.0).v);
                self.with(self.simd.$bits.$or(sign, self.constant(1.0).v))
            }

            #[inline(always)]
            fn if_positive(self, value: Self) -> Self {
                self.where_positive(value)
            }
        }
    };
}

pub(super) use lanes_in_register;
