//! The page of `scl watch` in a real browser.

use crate::browser::Browser;
use crate::client::Watch;
use crate::rover::Rover;
use crate::system::SpawnGuarded;
use scl_needs::needs;
use serde_json::Value;
use std::process::Stdio;

/// Opens the page in a browser.
fn open(rover: &Rover) -> (Watch, Browser) {
    open_with(rover, &["watch"])
}

/// Opens the page of a `scl watch` with these arguments.
fn open_with(rover: &Rover, arguments: &[&str]) -> (Watch, Browser) {
    let watch = Watch::start(rover.scl(arguments));
    let mut browser = Browser::start();
    browser.run(&format!("await page.goto('http://{}/?token={}')", watch.address, watch.token));
    (watch, browser)
}

/// Opens the page, and waits until it shows that the sensor runs.
fn open_running(rover: &Rover) -> (Watch, Browser) {
    let (watch, mut browser) = open(rover);
    browser.run(r#"await page.waitForSelector('.state-running[data-component="sensor"]')"#);
    (watch, browser)
}

/// The colour of a component's border.
fn border(browser: &mut Browser, component: &str) -> Value {
    browser.run(&format!(
        r#"return await page.$eval('[data-component="{component}"] > .border', (it) => getComputedStyle(it).stroke)"#
    ))
}

#[needs("node", "npm", "chromium")]
#[test]
fn a_killed_component_becomes_red_and_green_again() {
    let mut rover = Rover::start();
    let (_watch, mut browser) = open_running(&rover);
    assert_eq!(border(&mut browser, "sensor"), "rgb(26, 127, 55)");
    rover.kill("sensor");
    browser.run(r#"await page.waitForSelector('.state-dead[data-component="sensor"]')"#);
    assert_eq!(border(&mut browser, "sensor"), "rgb(196, 51, 29)");
    let problems = browser.run(r##"return await page.textContent("#problems")"##);
    assert!(problems.as_str().unwrap().contains("sensor was killed or has crashed"), "{problems}");
    rover.play(&["sensor"], |_| {});
    browser.run(r#"await page.waitForSelector('.state-running[data-component="sensor"]')"#);
    assert_eq!(browser.run("return errors"), serde_json::json!([]));
}

#[needs("node", "npm", "chromium")]
#[test]
fn a_click_at_a_gate_shows_its_messages_and_plots_a_number() {
    let rover = Rover::start();
    let (_watch, mut browser) = open_running(&rover);
    browser.run(r#"await page.click('[data-gate="sensor.measurements"]')"#);
    browser
        .run(r##"await page.waitForFunction(() => document.querySelector("#message").textContent.includes("speed"))"##);
    browser.run(r##"await page.selectOption("#field", "count")"##);
    browser.run(r##"await page.waitForFunction(() => document.querySelector("#plot path").getAttribute("d"))"##);
    browser.run(r#"await page.keyboard.press("Escape")"#);
    browser.run(r##"await page.waitForSelector("#details", { state: "hidden" })"##);
    // With the keyboard alone.
    browser.run(r#"await page.focus('[data-component="controller"]'); await page.keyboard.press("Enter")"#);
    browser.run(r##"await page.waitForFunction(() => document.querySelector("#facts").textContent.includes("MiB"))"##);
    assert_eq!(browser.run("return errors"), serde_json::json!([]));
}

#[needs("node", "npm", "chromium")]
#[test]
fn a_hostile_message_is_shown_as_text() {
    let hostile = r#"</script><img src=x onerror="window.harmed = true"><script>window.harmed = true</script>"#;
    let mut rover = Rover::stopped();
    rover.play_alone("logger");
    let message = serde_json::json!({ "text": hostile }).to_string();
    let mut sending = rover.scl(&["pub", "controller.log", &message, "--rate", "20"]);
    let _sending = sending.stdout(Stdio::null()).spawn_guarded();
    let (_watch, mut browser) = open(&rover);
    browser.run(r#"await page.click('[data-gate="logger.events"]')"#);
    browser.run(
        r##"await page.waitForFunction(() => document.querySelector("#message").textContent.includes("onerror"))"##,
    );
    assert_eq!(browser.run("return await page.evaluate(() => window.harmed === undefined)"), true);
    assert_eq!(browser.run("return await page.evaluate(() => document.images.length)"), 0);
    assert_eq!(browser.run("return errors"), serde_json::json!([]));
}

#[needs("node", "npm", "chromium")]
#[test]
fn a_component_leads_to_its_gates_and_what_can_be_done() {
    let rover = Rover::start();
    let (_watch, mut browser) = open_with(&rover, &["watch", "--control"]);
    browser.run(r#"await page.waitForSelector('.state-running[data-component="controller"]')"#);
    browser.run(r#"await page.click('[data-component="controller"] > .name')"#);
    browser.run(r##"await page.click("#stop")"##);
    browser.run(
        r##"await page.waitForFunction(() => document.querySelector("#done").textContent.includes("runs without `scl run`"))"##,
    );
    browser.run(r##"await page.click("#gates button:text-is('commands')")"##);
    assert_eq!(browser.run(r##"return await page.textContent("#subject")"##), "controller.commands");
    browser.run(
        r##"await page.waitForFunction(() => document.querySelector("#request").value.includes("target_speed"))"##,
    );
    browser.run(r##"await page.click("#send")"##);
    browser.run(
        r##"await page.waitForFunction(() => document.querySelector("#done").textContent.includes("every requester"))"##,
    );
    assert_eq!(browser.run("return errors"), serde_json::json!([]));
}

#[needs("node", "npm", "chromium")]
#[test]
fn a_recording_has_a_slider() {
    let rover = Rover::start();
    let output = rover.scl(&["record", "--for", "3s", "-o", "flight.mcap"]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let (_watch, mut browser) = open_with(&rover, &["watch", "--replay", "flight.mcap"]);
    browser.run(r##"await page.waitForFunction(() => document.querySelector("#time").textContent.includes(" of "))"##);
    browser.run(r#"await page.click('[data-gate="sensor.measurements"]')"#);
    browser.run(r#"await page.focus("body"); await page.keyboard.press(" ")"#);
    browser.run(r##"await page.waitForFunction(() => document.querySelector("#play").textContent === "▶")"##);
    let at = |browser: &mut Browser, position: &str| {
        browser.run(&format!(r##"await page.fill("#position", "{position}")"##));
        browser.run(&format!(
            r##"await page.waitForFunction(() => parseFloat(document.querySelector("#time").textContent) === {position})"##
        ));
        browser.run(
            r##"await page.waitForFunction(() => document.querySelector("#message").textContent.includes("speed"))"##,
        );
        browser.run(r##"return await page.textContent("#facts")"##)
    };
    assert_ne!(at(&mut browser, "2"), at(&mut browser, "0.5"));
    assert_eq!(browser.run("return errors"), serde_json::json!([]));
}

/// Three wheels of a kind, what drives them, and a display.
const WHEELS: &str = "
system: rover
schemas: [rover.proto]
kinds:
  - {name: wheel, gates: [setpoint: {sub: rover.Setpoint, queue: 1}]}
components:
  - {name: left, kind: wheel}
  - {name: right, kind: wheel}
  - {name: rear, kind: wheel}
  - {name: drive, gates: [wheels: {pub: rover.Setpoint}, speed: {pub: rover.Measurement}]}
  - {name: display, gates: [speed: {sub: rover.Measurement}]}
connections:
  - [drive.wheels, each wheel.setpoint]
  - [drive.speed, display.speed]
";

#[needs("node", "npm", "chromium")]
#[test]
fn components_of_a_kind_are_a_stack_that_opens() {
    let mut rover = Rover::of(WHEELS);
    rover.play(&["left", "right", "rear", "drive", "display"], |_| {});
    let (_watch, mut browser) = open(&rover);
    browser.run(r#"await page.waitForSelector('.state-running[data-stack="left right rear"]')"#);
    assert_eq!(browser.run("return await page.textContent('[data-stack] > .name')"), "wheel ×3");
    // The messages of all: three times 50 a second.
    browser
        .run("while (!(parseFloat(await page.textContent('[data-stack] .rate')) > 75)) await page.waitForTimeout(50)");
    assert_eq!(browser.run("return (await page.$$('.edge')).length"), 2);
    browser.run(r##"await page.fill("#search", "rear")"##);
    assert_eq!(browser.run("return (await page.$$('.block:not(.dim)')).length"), 1);

    rover.kill("right");
    browser.run("await page.waitForSelector('.state-dead[data-stack]')");
    browser.run("await page.click('[data-stack] > .name')");
    browser.run(r#"await page.waitForSelector('.state-dead[data-component="right"]')"#);
    browser.run(r#"await page.waitForSelector('.state-running[data-component="left"]')"#);
    assert_eq!(browser.run("return errors"), serde_json::json!([]));
}
