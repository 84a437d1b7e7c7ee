use crate::scene::gltf::uri::{Target, resolve};
use proptest::prelude::*;
use std::path::PathBuf;

#[test]
fn files_beside_the_scene_or_below() {
    for (uri, path) in [
        ("box.bin", "box.bin"),
        ("a/b/box.bin", "a/b/box.bin"),
        ("./box.bin", "./box.bin"),
        ("with%20space.png", "with space.png"),
        ("with space.png", "with space.png"),
        ("100%25.png", "100%.png"),
        ("%c3%a4.png", "ä.png"),
        ("..hidden/x", "..hidden/x"),
    ] {
        assert_eq!(resolve(uri).unwrap(), Target::File(PathBuf::from(path)), "{uri}");
    }
}

#[test]
fn nothing_elsewhere() {
    for uri in [
        "",
        "/etc/passwd",
        "//host/share",
        "../../etc/passwd",
        "a/../../etc/passwd",
        "%2e%2e/%2e%2e/etc/passwd",
        "%2E./x",
        "..%2fx",
        "%2fetc%2fpasswd",
        "..\\x",
        "a%5c..%5cx",
        "C:/x",
        "C%3a/x",
        "file:///etc/passwd",
        "FILE:x",
        "http://host/x.bin",
        "x%00.bin",
        "x%0a.bin",
        "%ff.bin",
        "x%2",
        "x%zz",
    ] {
        let fault = resolve(uri).expect_err(uri);
        assert_eq!(fault.code, "gltf-uri", "{uri}");
    }
}

#[test]
fn data_by_rfc_4648() {
    for (text, bytes) in [
        ("", ""),
        ("Zg==", "f"),
        ("Zm8=", "fo"),
        ("Zm9v", "foo"),
        ("Zm9vYg==", "foob"),
        ("Zm9vYmE=", "fooba"),
        ("Zm9vYmFy", "foobar"),
        ("Zm9vYg", "foob"),
    ] {
        let uri = format!("data:application/octet-stream;base64,{text}");
        assert_eq!(resolve(&uri).unwrap(), Target::Data(bytes.into()), "{text}");
    }
    assert_eq!(resolve("data:,a%20b").unwrap(), Target::Data(b"a b".to_vec()));
    for wrong in ["data:;base64,Zg=a", "data:;base64,Z", "data:;base64,Zm9v!", "data:nothing"] {
        assert!(resolve(wrong).is_err(), "{wrong}");
    }
}

proptest! {
    /// Whatever the text: no panic, and never a path out of the folder.
    #[test]
    fn paths_stay_inside(uri in "[.%/\\\\a-e0-9:x2ef]{0,12}") {
        if let Ok(Target::File(path)) = resolve(&uri) {
            prop_assert!(path.is_relative());
            prop_assert!(!path.components().any(|part| part.as_os_str() == ".."), "{:?}", path);
        }
    }
}
