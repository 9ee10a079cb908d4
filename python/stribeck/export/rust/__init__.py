"""A Rust module for the crate: the model as constants, test vectors, self-test."""

from __future__ import annotations

from stribeck.export.rust.files import rust_files

__all__ = ["rust_files"]
