//! The header is what cbindgen makes of this crate.

use std::path::Path;
use std::{env, fs};

#[test]
fn the_header_is_that_of_the_crate() {
    let crate_folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut header = Vec::new();
    cbindgen::generate(crate_folder).expect("the interface can be read").write(&mut header);
    let path = crate_folder.join("include/stribeck.h");
    if env::var_os("STRIBECK_BLESS").is_some() {
        fs::write(&path, &header).expect("the header can be written");
    }
    let kept = fs::read(&path).expect("the header is there");
    assert!(
        kept == header,
        "{} is not what the crate says: run STRIBECK_BLESS=1 cargo test -p stribeck-c",
        path.display()
    );
}
