//! Digests of contents.

use sha2::{Digest, Sha256};

/// A digest in hexadecimal digits, cut to 64 bits: it tells that something was changed, and need not resist an
/// attacker.
pub(crate) fn digest(content: impl AsRef<[u8]>) -> String {
    hexadecimal(&Sha256::digest(content.as_ref())[..8])
}

/// Bytes in hexadecimal digits.
pub(crate) fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
