//! Help: every command, in the name by which it was called.

use crate::xtask;

#[test]
fn help_names_every_command_and_no_other() {
    let ran = xtask(&["--help"]).done();
    for command in [
        "demo",
        "render",
        "merge",
        "simulate",
        "inertia",
        "list",
        "check",
        "reference",
        "accuracy",
        "speed",
        "stress",
        "ci",
    ] {
        assert!(
            ran.out.contains(&format!("\n  {command} ")),
            "{command}:\n{}",
            ran.out
        );
        let help = xtask(&[command, "--help"]).done().out;
        assert!(help.contains("Usage: cargo xtask"), "{help}");
        assert!(!help.contains("{carom}"), "{help}");
    }
    let help = xtask(&["render", "--help"]).done().out;
    assert!(help.contains("  cargo xtask render thesis"), "{help}");
    assert!(help.contains("(`cargo xtask list`)"), "{help}");
}
