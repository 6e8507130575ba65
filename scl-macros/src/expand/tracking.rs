//! Rebuild tracking: the compiler runs again when a file that was read changes.

use crate::locate::{Surroundings, without_dots};
use proc_macro2::TokenStream;
use quote::quote;
use std::path::{Path, PathBuf};

/// One `include_bytes!` for each file. Unreadable files need none, because a failed build is always repeated.
pub(super) fn expand_tracking(files: &[PathBuf], surroundings: &Surroundings) -> TokenStream {
    let paths = files.iter().filter_map(|file| absolute_path(&surroundings.working_dir, file));
    quote! { #(const _: &[u8] = ::core::include_bytes!(#paths);)* }
}

/// `None` if the path is not UTF-8: it cannot be written as a literal, so the file is not tracked.
fn absolute_path(working_dir: &Path, file: &Path) -> Option<String> {
    without_dots(&working_dir.join(file)).to_str().map(str::to_owned)
}
