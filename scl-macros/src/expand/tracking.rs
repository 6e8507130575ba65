//! A change of a file that was read makes the compiler run again.

use crate::locate::{Surroundings, without_dots};
use proc_macro2::TokenStream;
use quote::quote;
use std::path::{Path, PathBuf};

/// One `include_bytes!` a file. Files that could not be read need none: a failed build is always tried again.
pub(super) fn expand_tracking(files: &[PathBuf], surroundings: &Surroundings) -> TokenStream {
    let paths = files.iter().filter_map(|file| literal(&surroundings.working, file));
    quote! { #(const _: &[u8] = ::core::include_bytes!(#paths);)* }
}

/// The absolute path; a path that is no UTF-8 cannot stand in a literal and is not tracked.
fn literal(working: &Path, file: &Path) -> Option<String> {
    without_dots(&working.join(file)).to_str().map(str::to_owned)
}
