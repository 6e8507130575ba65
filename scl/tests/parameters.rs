//! The parameters of components: defaults, values that are set, and what is refused.

use scl::{OpenError, OpenOptions, Result};
use std::time::Duration;

scl::topology!("parameters.yaml");

fn in_folder(folder: &tempfile::TempDir) -> OpenOptions {
    OpenOptions::new().runtime_dir(folder.path())
}

#[tokio::test]
async fn parameters_have_their_defaults() -> Result<()> {
    let (controller, _peer) = Controller::test().await?;
    let expected = ControllerParameters {
        gain: 0.8,
        period: Duration::from_millis(10),
        label: "left".to_owned(),
        enabled: true,
        mode: ControllerMode::Manual,
        offsets: [0.0, 0.5, 1.0],
        names: vec!["a, b".to_owned(), "c".to_owned()],
        r#type: -1,
    };
    assert_eq!(controller.parameters, expected);
    Ok(())
}

#[tokio::test]
async fn values_that_are_set_take_the_place_of_defaults() -> Result<()> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let options = in_folder(&folder)
        .set("controller.gain", "2")
        .set("controller.gain", "3")
        .set("controller.mode", "full-auto")
        .set("controller.offsets", "[1, 2, 3]")
        .set("controller.names", "[]")
        .set("front-motor.pin", "7");
    let controller = Controller::open_with(options).await?.parameters;
    assert_eq!((controller.gain, controller.mode), (3.0, ControllerMode::FullAuto));
    assert_eq!((controller.offsets, controller.names), ([1.0, 2.0, 3.0], Vec::new()));
    assert_eq!(ControllerMode::ALL.iter().map(|mode| mode.to_string()).collect::<Vec<_>>(), ["manual", "full-auto"]);
    Ok(())
}

#[tokio::test]
async fn each_component_of_a_kind_has_its_own_values() -> Result<()> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let options = || {
        in_folder(&folder).set("front-motor.pin", "1").set("back-motor.pin", "2").set("back-motor.direction", "right")
    };
    let front = Motor::open_as_with(MotorInstance::FrontMotor, options()).await?;
    let back = Motor::open_as_with(MotorInstance::BackMotor, options()).await?;
    let values = |motor: &Motor| (motor.parameters.pin, motor.parameters.direction);
    assert_eq!((values(&front), values(&back)), ((1, MotorDirection::Left), (2, MotorDirection::Right)));
    let (tested, _peer) = Motor::test_with(OpenOptions::new().set("front-motor.pin", "3")).await?;
    assert_eq!(tested.parameters.pin, 3);
    Ok(())
}

/// The error, and that nothing of the component is left behind.
async fn refused(parameter: &str, value: &str) -> String {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let error = Controller::open_with(in_folder(&folder).set(parameter, value)).await.err().expect("it is refused");
    assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 0);
    error.to_string()
}

#[tokio::test]
async fn wrong_values_are_refused_before_anything_of_the_component_exists() {
    let gain = "parameter `controller.gain` cannot have the value that it is set to: ";
    assert_eq!(refused("controller.gain", "11").await, format!("{gain}`11` is not from 0 to 10"));
    assert_eq!(refused("controller.gain", "high").await, format!("{gain}expected a finite number, found `high`"));
    let unknown = "component `controller` has no parameter `gian`, which is set; did you mean `gain`?";
    assert_eq!(refused("controller.gian", "1").await, unknown);
    let text = "component `controller` cannot be opened: expected `component.parameter=value`, found `gain=1`";
    assert_eq!(refused("gain", "1").await, text);
}

/// A player of a recording takes the place of a program, and gives its gates only.
#[tokio::test]
async fn what_stands_in_for_a_component_needs_no_values() -> Result<()> {
    use scl::plan::{ParameterPlan, ParameterType, Plan, Scalar};
    let folder = tempfile::tempdir().expect("a temporary folder");
    let pin = ParameterPlan {
        name: "pin".into(),
        kind: ParameterType::One(Scalar::U8),
        default: None,
        range: None,
        unit: None,
        doc: None,
        live: false,
        declared_at: "".into(),
    };
    let plan = Plan {
        system: "parameters".to_owned(),
        component: "player".to_owned(),
        declared_at: String::new(),
        schema: None,
        parameters: vec![pin],
        gates: Vec::new(),
    };
    let options = || in_folder(&folder).set("player.pin", "300");
    let error = scl::untyped::Component::open_with(&plan, options()).await.expect_err("the value is wrong");
    assert!(matches!(error, OpenError::WrongValue { .. }), "{error:?}");
    let player = scl::untyped::Component::open_with(&plan, options().stands_in()).await?;
    assert_eq!(player.parameter("pin"), None);
    Ok(())
}

#[tokio::test]
async fn a_parameter_without_default_needs_a_value() {
    let error = Motor::test().await.err().expect("no value is given");
    assert!(matches!(error, OpenError::NoValue { component: "front-motor", parameter: "pin", .. }), "{error:?}");
    let expected = "parameter `front-motor.pin` (u8) has no value: set it under `parameters` in the launch file, with \
                    `scl run --set front-motor.pin=...`, or in the environment, `SCL_SET=front-motor.pin=...`";
    assert_eq!(error.to_string(), expected);
}
