//! IES files: symmetries, tilt, and what is wrong with damaged ones.

mod mutate;

use std::path::Path;
use tyndall_files::photometry::{IesProfile, decode_ies};

fn file(tilt: &str, kind: u32, horizontal: &str, candela: &str) -> String {
    let columns = horizontal.split_whitespace().count();
    format!(
        "IESNA:LM-63-2002\n[TEST] a lamp\n{tilt}\n1 1000 2.0 3 {columns} {kind} 2 0 0 0\r\n0.5 1 60\n0 45 90\n{horizontal}\n{candela}\n"
    )
}

fn read(text: &str) -> Result<IesProfile, String> {
    decode_ies(text, Path::new("lamp.ies")).map_err(|e| e.to_string())
}

#[test]
fn a_round_lamp_is_the_same_all_round() {
    let p = read(&file("TILT=NONE", 1, "0", "9 5 1")).expect("valid");
    assert_eq!((p.vertical, p.horizontal), (vec![0.0, 45.0, 90.0], vec![0.0, 360.0]));
    // the multiplier is 2, the ballast factor 0.5
    assert_eq!(p.candela, [9.0, 5.0, 1.0, 9.0, 5.0, 1.0]);
}

#[test]
fn symmetries_are_unfolded() {
    let p = read(&file("TILT=NONE", 1, "0 90", "1 2 3 4 5 6")).expect("valid");
    assert_eq!(p.horizontal, [0.0, 90.0, 180.0, 270.0, 360.0]);
    assert_eq!(p.candela[6..], [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 1.0, 2.0, 3.0]);
    let p = read(&file("TILT=NONE", 1, "0 60 180", "1 2 3 4 5 6 7 8 9")).expect("valid");
    assert_eq!(p.horizontal, [0.0, 60.0, 180.0, 300.0, 360.0]);
    assert_eq!(p.candela[9..], [4.0, 5.0, 6.0, 1.0, 2.0, 3.0]);
    let p = read(&file("TILT=NONE", 1, "90 180 270", "1 2 3 4 5 6 7 8 9")).expect("valid");
    assert_eq!(p.horizontal, [0.0, 90.0, 180.0, 270.0, 360.0]);
    assert_eq!(p.candela[..6], [4.0, 5.0, 6.0, 1.0, 2.0, 3.0]);
}

#[test]
fn a_tilt_table_is_skipped() {
    let p = read(&file("TILT=INCLUDE\n1\n2\n0 90\n1 0.9", 1, "0", "9 5 1")).expect("valid");
    assert_eq!(p.candela[0], 9.0);
}

#[test]
fn damage_is_told_with_its_line() {
    for (text, want) in [
        (file("TILT=NONE", 1, "0", "9 five 1"), "lamp.ies:8: expected candela value, got \"five\""),
        (file("TILT=NONE", 1, "0", "9 5"), "got the end of the file"),
        (file("TILT=NONE", 1, "0", "9 -5 1"), "expected a candela value >= 0, got -5"),
        (file("TILT=NONE", 1, "0 50 20", "9 5 1 9 5 1 9 5 1"), "ascending, got 20"),
        (file("TILT=NONE", 1, "0 50", "9 5 1 9 5 1"), "or from 90 to 270"),
        (file("TILT=NONE", 2, "0", "9 5 1"), "type A or B"),
        (file("TILT", 1, "0", "9 5 1"), "TILT="),
        (file("TILT=NONE", 1, "0", "9 5 1").replace("2.0 3 1", "2.0 60000 60000"), "intensities"),
    ] {
        let message = read(&text).expect_err(want);
        assert!(message.contains(want), "{message}");
    }
}

/// Found by damaged copies: finite numbers whose product is not.
#[test]
fn multipliers_that_overflow_are_refused() {
    let text = file("TILT=NONE", 1, "0", "9 5 1").replace("\n0.5 1 60", "\n1e38 1 60");
    let message = read(&text).expect_err("too bright");
    assert!(message.contains("multipliers") && message.contains("inf"), "{message}");
    let negative = file("TILT=NONE", 1, "0", "9 5 1").replace("1000 2.0", "1000 -2.0");
    assert!(read(&negative).expect_err("negative").contains("multipliers"));
}

/// Every prefix and every change of one byte: an error or a profile, never a panic.
#[test]
fn cut_and_changed_files_do_no_harm() {
    let text = file("TILT=INCLUDE\n1\n2\n0 90\n1 0.9", 1, "0 90", "1 2 3 4 5 6");
    for end in 0..text.len() {
        let _ = read(&text[..end]);
        for byte in ["0", "-", "9", "e", " ", "\n"] {
            let _ = read(&format!("{}{byte}{}", &text[..end], &text[end + 1..]));
        }
    }
}

fn survive(count: u32) {
    let tilted = file("TILT=INCLUDE\n1\n2\n0 90\n1 0.9", 1, "0 90", "1 2 3 4 5 6");
    let seeds =
        [tilted, file("TILT=NONE", 1, "0", "9 5 1"), file("TILT=NONE", 1, "90 180 270", "1 2 3 4 5 6 7 8 9")];
    mutate::survive(&seeds.map(String::into_bytes), count, |bytes| {
        if let Ok(p) = read(&String::from_utf8_lossy(bytes)) {
            assert_eq!(p.candela.len(), p.vertical.len() * p.horizontal.len());
            assert!(p.candela.iter().all(|c| *c >= 0.0 && c.is_finite()), "{p:?}");
        }
    });
}

#[test]
fn damaged_copies() {
    survive(mutate::SHORT);
}

#[test]
#[ignore = "long: TYNDALL_FUZZ copies"]
fn many_damaged_copies() {
    survive(mutate::long());
}
