//! Every case fails to compile, with exactly the expected text. `TRYBUILD=overwrite` writes the texts anew.

#[test]
fn wrong_wiring_does_not_compile() {
    trybuild::TestCases::new().compile_fail("cases/*/main.rs");
}
