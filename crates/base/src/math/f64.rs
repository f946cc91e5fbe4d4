//! Double-precision functions that give the same bits on every machine: the crate `libm`, version pinned.

macro_rules! unary {
    ($($(#[$doc:meta])* $name:ident => $target:ident),+ $(,)?) => {
        $($(#[$doc])*
        #[inline]
        pub fn $name(x: f64) -> f64 {
            libm::$target(x)
        })+
    };
}

unary! {
    /// `e^x`.
    exp => exp,
    /// `2^x`.
    exp2 => exp2,
    /// `e^x - 1`, precise near zero.
    exp_m1 => expm1,
    /// Natural logarithm.
    ln => log,
    /// `ln(1 + x)`, precise near zero.
    ln_1p => log1p,
    /// Logarithm to base 2.
    log2 => log2,
    /// Logarithm to base 10.
    log10 => log10,
    /// Sine of radians.
    sin => sin,
    /// Cosine of radians.
    cos => cos,
    /// Tangent of radians.
    tan => tan,
    /// Arc sine in radians.
    asin => asin,
    /// Arc cosine in radians.
    acos => acos,
    /// Arc tangent in radians.
    atan => atan,
    /// Hyperbolic sine.
    sinh => sinh,
    /// Hyperbolic cosine.
    cosh => cosh,
    /// Hyperbolic tangent.
    tanh => tanh,
    /// Inverse hyperbolic tangent.
    atanh => atanh,
    /// Cubic root.
    cbrt => cbrt,
    /// Error function.
    erf => erf,
}

/// `(sin x, cos x)` of radians.
#[inline]
pub fn sin_cos(x: f64) -> (f64, f64) {
    libm::sincos(x)
}

/// The angle of the point `(x, y)` in `[-pi, pi]` radians.
#[inline]
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// `x^y`.
#[inline]
pub fn pow(x: f64, y: f64) -> f64 {
    libm::pow(x, y)
}

/// `sqrt(x^2 + y^2)` without overflow.
#[inline]
pub fn hypot(x: f64, y: f64) -> f64 {
    libm::hypot(x, y)
}
