//! Which instruction set runs: found at run time, one wheel for every machine.
//!
//! The one idea: a kernel body is written once, generic over [`Vector8`](super::lanes::Vector8), and
//! `tiered!` compiles it three times. All tiers do the same IEEE operations in the same order, so the
//! choice changes the speed and never a bit. `VISVIVA_SIMD=portable|avx2|avx512` overrides it.

use crate::error::{Error, Result};
use core::sync::atomic::{AtomicU8, Ordering};

/// An instruction-set tier.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Tier {
    /// Whatever the build targets (SSE2 on x86-64, NEON on aarch64).
    Portable = 1,
    /// 256-bit AVX2 and FMA.
    Avx2 = 2,
    /// 512-bit AVX-512 F, DQ, VL, beside AVX2 and FMA.
    Avx512 = 3,
}

impl Tier {
    /// Its name, as `VISVIVA_SIMD` takes it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Portable => "portable",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }
    /// The best tier of this machine.
    pub fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            let avx2 = is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma");
            if avx2
                && is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512vl")
            {
                return Self::Avx512;
            }
            if avx2 {
                return Self::Avx2;
            }
        }
        Self::Portable
    }
}

/// 0 until resolved.
static TIER: AtomicU8 = AtomicU8::new(0);

/// The tier in force.
#[inline(always)]
pub fn tier() -> Tier {
    match TIER.load(Ordering::Relaxed) {
        3 => Tier::Avx512,
        2 => Tier::Avx2,
        1 => Tier::Portable,
        _ => first(),
    }
}

/// Where nobody asked before. A function of its own: inlined, what it leaves to drop would burden every loop.
#[cold]
#[inline(never)]
fn first() -> Tier {
    resolve().unwrap_or(Tier::Portable)
}

/// Reads `VISVIVA_SIMD` once and fixes the tier.
///
/// # Errors
/// An unknown name, or a tier that this machine lacks.
#[cold]
pub fn resolve() -> Result<Tier> {
    let best = Tier::detect();
    let wanted = match std::env::var("VISVIVA_SIMD").ok().as_deref() {
        None | Some("" | "auto") => best,
        Some("portable") => Tier::Portable,
        Some("avx2") => Tier::Avx2,
        Some("avx512") => Tier::Avx512,
        Some(other) => {
            return Err(Error::invalid(
                "VISVIVA_SIMD",
                format!("expected portable, avx2 or avx512, got '{other}'"),
            ));
        }
    };
    if wanted > best {
        return Err(Error::invalid(
            "VISVIVA_SIMD",
            format!("this machine has no {}; the best it has is {}", wanted.name(), best.name()),
        ));
    }
    TIER.store(wanted as u8, Ordering::Relaxed);
    Ok(wanted)
}

/// Asks for the line of memory at `address` to be brought near; it need not be memory of ours.
#[inline(always)]
pub fn prefetch(address: *const f64) {
    #[cfg(target_arch = "x86_64")]
    {
        use core::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        // SAFETY: every x86-64 has the instruction, and it does nothing where there is no memory.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(address.cast()) };
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = address;
}

/// Compiles one kernel body for every tier and dispatches to the one in force.
///
/// `tiered! { pub fn name[P: Bound][P](argument: Type) -> Return = body; }` defines
/// `name::<P>(argument)`, which calls `body::<V, P>(argument)` with `V` the tier's
/// [`Vector8`](crate::numerics::lanes::Vector8).
/// The body must be `#[inline(always)]`, else it is compiled without the tier's instructions.
macro_rules! tiered {
    ($(
        $(#[$meta:meta])*
        $vis:vis fn $name:ident [$($bounds:tt)*][$($generics:tt)*] ($($argument:ident : $type:ty),* $(,)?) $(-> $return:ty)? = $body:ident;
    )+) => {$(
        $(#[$meta])*
        #[allow(clippy::allow_attributes, clippy::unused_unit, unused_results)]
        $vis fn $name<$($bounds)*>($($argument: $type),*) $(-> $return)? {
            #[cfg(target_arch = "x86_64")]
            {
                use $crate::numerics::{lanes, simd::Tier};
                #[target_feature(enable = "avx512f,avx512dq,avx512vl,avx2,fma")]
                fn avx512<$($bounds)*>($($argument: $type),*) $(-> $return)? {
                    $body::<lanes::Avx512, $($generics)*>($($argument),*)
                }
                #[target_feature(enable = "avx2,fma")]
                fn avx2<$($bounds)*>($($argument: $type),*) $(-> $return)? {
                    $body::<lanes::Avx2, $($generics)*>($($argument),*)
                }
                match $crate::numerics::simd::tier() {
                    // SAFETY: `tier()` returns a tier only after the machine was seen to have it.
                    Tier::Avx512 => return unsafe { avx512::<$($generics)*>($($argument),*) },
                    // SAFETY: as above.
                    Tier::Avx2 => return unsafe { avx2::<$($generics)*>($($argument),*) },
                    Tier::Portable => {}
                }
            }
            // A function of its own: inlined, its registers and stack would burden the way to the others.
            #[inline(never)]
            fn portable<$($bounds)*>($($argument: $type),*) $(-> $return)? {
                $body::<$crate::numerics::lanes::Lanes, $($generics)*>($($argument),*)
            }
            portable::<$($generics)*>($($argument),*)
        }
    )+};
}

pub(crate) use tiered;
