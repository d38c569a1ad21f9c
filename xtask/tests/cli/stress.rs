//! `stress`: one case by name, and an unknown name.

use crate::xtask;

#[test]
fn a_case_is_found_by_name_and_by_number() {
    for case in ["windings", "7"] {
        let ran = xtask(&["stress", "--case", case]).done();
        assert!(ran.out.contains("1 of 1 cases pass"), "{}", ran.out);
    }
}

#[test]
fn an_unknown_case_gets_the_list() {
    xtask(&["stress", "--case", "earthquake"]).refused(&["earthquake", "windings (7)"]);
}
