//! The header is the output of cbindgen for this crate.

use std::path::Path;
use std::{env, fs};

#[test]
fn the_header_is_up_to_date() {
    let crate_folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut header = Vec::new();
    cbindgen::generate(crate_folder).expect("the interface is readable").write(&mut header);
    let path = crate_folder.join("include/stribeck.h");
    if env::var_os("STRIBECK_BLESS").is_some() {
        fs::write(&path, &header).expect("the header is writable");
    }
    let kept = fs::read(&path).expect("the header exists");
    assert!(
        kept == header,
        "{} is out of date: run STRIBECK_BLESS=1 cargo test -p stribeck-c",
        path.display()
    );
}
