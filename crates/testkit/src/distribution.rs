//! Distribution functions and quantiles: a thin layer over `statrs`, in the names tests use.

use statrs::distribution::{ChiSquared, ContinuousCDF, Normal, StudentsT};

fn normal() -> Normal {
    Normal::new(0.0, 1.0).expect("unit variance is valid")
}

fn student(dof: f64) -> StudentsT {
    StudentsT::new(0.0, 1.0, dof).expect("degrees of freedom must be positive")
}

/// P(Z <= z) of the standard normal distribution.
pub fn normal_cdf(z: f64) -> f64 {
    normal().cdf(z)
}

/// The `p` quantile of the standard normal distribution.
pub fn normal_quantile(p: f64) -> f64 {
    normal().inverse_cdf(p)
}

/// P(|Z| >= |z|), precise in the tail.
pub fn normal_two_sided(z: f64) -> f64 {
    2.0 * normal().sf(z.abs())
}

/// P(T <= t) of Student's distribution.
pub fn student_cdf(t: f64, dof: f64) -> f64 {
    student(dof).cdf(t)
}

/// The `p` quantile of Student's distribution.
pub fn student_quantile(p: f64, dof: f64) -> f64 {
    student(dof).inverse_cdf(p)
}

/// P(|T| >= |t|) of Student's distribution, precise in the tail.
pub fn student_two_sided(t: f64, dof: f64) -> f64 {
    2.0 * student(dof).sf(t.abs())
}

/// P(X >= x) of the chi-square distribution.
pub fn chi2_upper(x: f64, dof: f64) -> f64 {
    ChiSquared::new(dof).expect("degrees of freedom must be positive").sf(x)
}
