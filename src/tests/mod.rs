//! Slow oracles, which read the library's own parts.

mod accuracy;
mod oracle;
