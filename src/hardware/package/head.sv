`default_nettype none

/// Every width, size and packed struct of the design. Printed by `Hardware::package` in Rust (src/hardware) and never edited: `scripts/package` writes it again.
///
/// A struct `foo::In` in Rust is `foo_in_t` here, field for field, the first field most significant; `[T; N]` is `logic [N-1:0][W-1:0]`, element
/// 0 least significant (arrays of structs are kept flat, because free synthesis tools mistake them). `tests/mirror` reads it back and compares the two.
package lod_pkg;
