//! Numbers that are needed: how many bits they have, and the most of several.

/// Bits of a number that counts up to `most`: none for 0.
pub(crate) fn bits(most: u64) -> u32 {
    u64::BITS - most.leading_zeros()
}

/// Bits of a two's complement number that holds `least` to `most`: none if both are 0.
pub(crate) fn signed_bits(least: i64, most: i64) -> u32 {
    let magnitude = |v: i64| bits((if v < 0 { !v } else { v }).cast_unsigned());
    if least == 0 && most == 0 { 0 } else { magnitude(least).max(magnitude(most)) + 1 }
}

/// Zeros at the bottom of no number at all.
pub(crate) const ALL_ZEROS: u32 = 32;

/// Declares needs: for each field the most of two, of fields that end in `zeros` the least.
macro_rules! needs {
    ($(#[$doc:meta])* pub struct $name:ident {
        most { $($(#[$mdoc:meta])* $most:ident: $mty:ty,)* }
        least { $($(#[$ldoc:meta])* $least:ident,)* }
    }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
        #[serde(deny_unknown_fields, rename_all = "kebab-case")]
        pub struct $name {
            $($(#[$mdoc])* pub $most: $mty,)*
            $($(#[$ldoc])* pub $least: u32,)*
        }

        impl Default for $name {
            /// Of nothing: 0 in all, and zeros as many as there can be.
            fn default() -> Self {
                Self { $($most: Default::default(),)* $($least: $crate::plan::needs::ALL_ZEROS,)* }
            }
        }

        impl $name {
            /// What serves both.
            #[must_use]
            pub fn with(&self, other: &Self) -> Self {
                Self { $($most: self.$most.max(other.$most),)* $($least: self.$least.min(other.$least),)* }
            }
        }
    };
}
pub(crate) use needs;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_by_hand() {
        assert_eq!([0, 1, 2, 255, 256].map(bits), [0, 1, 2, 8, 9]);
        assert_eq!(signed_bits(0, 0), 0);
        assert_eq!(
            [signed_bits(-1, 0), signed_bits(0, 1), signed_bits(-128, 127), signed_bits(-129, 0), signed_bits(0, 128)],
            [1, 2, 8, 9, 9]
        );
    }
}
