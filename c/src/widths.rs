//! Numbers of C as the ports' widths have them: what does not fit is refused by the name of its field.

use crate::error::{Refused, refused};
use lodray::num::{S, U, Vec3};

/// An unsigned number of `W` bits.
pub fn unsigned<const W: u32>(name: &str, value: u64) -> Result<U<W>, Refused> {
    U::checked(value).ok_or(()).or_else(|()| refused(format!("{name}: {value} does not fit {W} bits")))
}

/// A signed number of `W` bits.
fn signed<const W: u32>(name: &str, value: i32) -> Result<S<W>, Refused> {
    S::checked(value.into()).ok_or(()).or_else(|()| refused(format!("{name}: {value} does not fit {W} bits, signed")))
}

/// Three signed numbers of `W` bits.
pub fn vector<const W: u32>(name: &str, value: [i32; 3]) -> Result<Vec3<W>, Refused> {
    let [x, y, z] = value;
    Ok(Vec3 { x: signed(name, x)?, y: signed(name, y)?, z: signed(name, z)? })
}

/// Three numbers of at most 32 bits.
pub fn three<const W: u32>(of: Vec3<W>) -> [i32; 3] {
    of.get().map(|v| v as i32) // no vector at a port is wider
}
