//! Runtime folders in which anything lies about. What the fuzz target finds becomes a case here.

use scl_tests::fuzz::{Generator, runtime_folder};

#[test]
fn a_component_opens_in_any_folder_or_says_what_is_in_its_way() {
    let mut generator = Generator::new(3);
    for _ in 0..100 {
        let mut input = generator.noise(200);
        // In most, the folders themselves are sound.
        input.splice(0..0, [9, 9]);
        runtime_folder(&input);
        runtime_folder(&generator.noise(100));
    }
}
