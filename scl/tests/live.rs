//! Live parameters: changed by the program, by tools and by plain ZeroMQ programs, and what is refused.

use scl::parameters::{AskError, ask_to_set, values};
use scl::runtime_dir::{RuntimeDir, SystemDir};
use scl::{BlockingError, OpenOptions, Result, SetError};
use std::time::Duration;
use tempfile::TempDir;
use zeromq::{ReqSocket, Socket, SocketRecv, SocketSend};

scl::topology!("live.yaml");

const MINUTE: Duration = Duration::from_secs(60);

fn folder() -> (TempDir, OpenOptions) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let options = OpenOptions::new().runtime_dir(folder.path());
    (folder, options)
}

fn system(folder: &TempDir) -> SystemDir {
    let runtime_dir = RuntimeDir::locate(&|name| (name == "SCL_RUNTIME_DIR").then(|| folder.path().into()));
    runtime_dir.and_then(|it| it.system("live")).expect("a folder")
}

fn value(folder: &TempDir, name: &str) -> String {
    let values = values(&system(folder), "tuner").expect("values");
    values.into_iter().find(|(known, _)| known == name).expect("a value").1
}

async fn ask(folder: &TempDir, wanted: &[(&str, &str)]) -> std::result::Result<(), AskError> {
    ask_to_set(&system(folder), "tuner", wanted.iter().copied(), MINUTE).await
}

#[tokio::test]
async fn a_program_changes_its_own_parameters() -> Result<()> {
    let (mut tuner, _peer) = Tuner::test_with(OpenOptions::new().set("tuner.gain", "2")).await?;
    let parameters = &mut tuner.parameters;
    assert_eq!((parameters.gain.get(), parameters.gain.try_changed()), (2.0, None), "it is as it was opened");
    parameters.gain.set("3").expect("it is set");
    parameters.gain.set("4").expect("it is set");
    parameters.mode.set("full-auto").expect("it is set");
    assert_eq!(parameters.gain.changed().await, Ok(4.0), "the newest value");
    assert_eq!((parameters.gain.try_changed(), parameters.gain.get()), (None, 4.0), "each change is told once");
    assert_eq!((parameters.mode.get(), parameters.offsets.try_changed()), (TunerMode::FullAuto, None));
    parameters.gain.set("4.0").expect("it is set");
    assert_eq!(parameters.gain.try_changed(), None, "it is the same value");
    let wrong =
        SetError::WrongValue { component: "tuner", parameter: "gain", reason: "`11` is not from 0 to 10".to_owned() };
    assert_eq!(parameters.gain.set("11"), Err(wrong));
    assert_eq!(parameters.gain.get(), 4.0);
    let (mut clone, before) = (parameters.gain.clone(), parameters.clone());
    parameters.gain.set("5").expect("it is set");
    assert_eq!((clone.try_changed(), parameters.gain.try_changed()), (Some(5.0), Some(5.0)));
    assert_eq!(&before, parameters, "clones have the same values");
    assert_eq!(format!("{:?}", parameters.gain), "5.0");
    Ok(())
}

#[tokio::test]
async fn a_change_wakes_those_who_wait() -> Result<()> {
    let (tuner, _peer) = Tuner::test().await?;
    let (mut waiting, mut other) = (tuner.parameters.gain.clone(), tuner.parameters.mode.clone());
    let waiter = tokio::spawn(async move { waiting.changed().await });
    tokio::task::yield_now().await;
    tuner.parameters.offsets.set("[1]").expect("it is set");
    tuner.parameters.gain.set("6").expect("it is set");
    assert_eq!(waiter.await.expect("the task ends"), Ok(6.0));
    let waited = tokio::time::timeout(Duration::from_millis(1), other.changed()).await;
    assert!(waited.is_err(), "changes of others do not count");
    Ok(())
}

#[tokio::test]
async fn tools_set_parameters_of_a_running_component() -> Result<()> {
    let (folder, options) = folder();
    let mut tuner = Tuner::open_with(options.set("tuner.name", "a \"b\"")).await?;
    assert_eq!(value(&folder, "name"), "a \"b\"");
    assert_eq!((value(&folder, "gain"), value(&folder, "pin")), ("0.8".to_owned(), "4".to_owned()));
    ask(&folder, &[("gain", "2.50"), ("mode", "full-auto"), ("offsets", "[-1, 2]"), ("period", "2s")]).await?;
    let parameters = &mut tuner.parameters;
    assert_eq!(parameters.gain.changed().await?, 2.5);
    assert_eq!((parameters.mode.get(), parameters.offsets.get()), (TunerMode::FullAuto, vec![-1, 2]));
    assert_eq!((parameters.period.get(), parameters.name.get()), (Duration::from_secs(2), "a \"b\"".to_owned()));
    assert_eq!((value(&folder, "gain"), value(&folder, "offsets")), ("2.50".to_owned(), "[-1, 2]".to_owned()));
    drop(tuner);
    assert_eq!(value(&folder, "gain"), "2.50", "the values stay for the next start");
    let _again = Tuner::open_with(OpenOptions::new().runtime_dir(folder.path())).await?;
    assert_eq!(value(&folder, "gain"), "0.8", "a start without them begins anew");
    Ok(())
}

/// The reason for which a component refuses values.
async fn refused(folder: &TempDir, wanted: &[(&str, &str)]) -> String {
    match ask(folder, wanted).await {
        Err(AskError::Refused { reason }) => reason,
        other => panic!("{other:?}"),
    }
}

#[tokio::test]
async fn wrong_values_change_nothing() -> Result<()> {
    let (folder, options) = folder();
    let mut tuner = Tuner::open_with(options).await?;
    let told = refused(&folder, &[("mode", "full-auto"), ("gain", "high")]).await;
    assert_eq!(told, "parameter `tuner.gain` cannot have this value: expected a finite number, found `high`");
    let told = refused(&folder, &[("mode", "full-auto"), ("gian", "1")]).await;
    assert_eq!(told, "component `tuner` has no parameter `gian`; did you mean `gain`?");
    let told = refused(&folder, &[("mode", "full-auto"), ("pin", "1")]).await;
    let fixed = "parameter `tuner.pin` is fixed while its program runs: its declaration does not say `live: true`; \
                 give the value at the start, with `scl run --set tuner.pin=...`";
    assert_eq!(told, fixed);
    let long = "x".repeat(100_000);
    assert!(refused(&folder, &[("name", &long)]).await.contains("the value has 100000 bytes, and may have 65536"));
    assert_eq!((tuner.parameters.mode.try_changed(), tuner.parameters.gain.get()), (None, 0.8));
    assert_eq!(value(&folder, "mode"), "manual");
    Ok(())
}

#[tokio::test]
async fn a_plain_zeromq_program_sets_parameters() -> Result<()> {
    let (folder, options) = folder();
    let tuner = Tuner::open_with(options).await?;
    let mut socket = ReqSocket::new();
    socket.connect(&format!("ipc://{}/live/tuner.set", folder.path().display())).await.expect("it connects");
    let cases = [
        (r#"{"gain": 7, "offsets": [1, 2]}"#, "{}"),
        (r#"{"mode": "atuo"}"#, r#"{"error":"parameter `tuner.mode` cannot have this value: "#),
        ("gain=2", r#"{"error":"expected an object of names and values like {\"gain\": \"2\"}: "#),
        ("{}", "{}"),
    ];
    for (request, expected) in cases {
        socket.send(request.into()).await.expect("it is sent");
        let reply = socket.recv().await.expect("a reply");
        let reply = String::from_utf8(reply.get(0).expect("a frame").to_vec()).expect("a text");
        assert!(reply.starts_with(expected), "{request}: {reply}");
    }
    assert_eq!((tuner.parameters.gain.get(), tuner.parameters.offsets.get()), (7.0, vec![1, 2]));
    Ok(())
}

#[tokio::test]
async fn one_who_sets_all_the_time_loses_nothing() -> Result<()> {
    let (folder, options) = folder();
    let mut tuner = Tuner::open_with(options).await?;
    let ten_at_once = (0..10).map(|number| {
        let folder = &folder;
        async move {
            for step in 0..100 {
                ask(folder, &[("offsets", &format!("[{number}, {step}]"))]).await.expect("it is set");
            }
        }
    });
    futures(ten_at_once.collect()).await;
    let newest = tuner.parameters.offsets.changed().await?;
    assert_eq!((newest.len(), newest[1]), (2, 99), "the last step of one of them");
    assert_eq!(value(&folder, "offsets"), format!("[{}, 99]", newest[0]), "the file has the newest value");
    assert_eq!(tuner.parameters.offsets.try_changed(), None);
    Ok(())
}

/// Waits for all of them at the same time.
async fn futures<F: Future<Output = ()>>(all: Vec<F>) {
    let mut all: Vec<_> = all.into_iter().map(Box::pin).collect();
    std::future::poll_fn(|cx| {
        all.retain_mut(|one| one.as_mut().poll(cx).is_pending());
        if all.is_empty() { std::task::Poll::Ready(()) } else { std::task::Poll::Pending }
    })
    .await;
}

#[test]
fn a_program_without_async_takes_values_over() {
    let (folder, options) = folder();
    let mut tuner = Tuner::open_blocking_with(options).expect("it opens");
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().expect("a runtime");
    // The component has a thread of its own that answers while the program does something else.
    runtime.block_on(ask(&folder, &[("gain", "3")])).expect("it is set");
    assert_eq!(tuner.parameters.gain.changed_blocking(), Ok(3.0));
    assert_eq!(tuner.parameters.gain.changed_timeout(Duration::from_millis(1)), Ok(None));
    tuner.parameters.gain.set("4").expect("it is set");
    assert_eq!(tuner.parameters.gain.changed_timeout(MINUTE), Ok(Some(4.0)));
    runtime.block_on(async {
        assert_eq!(tuner.parameters.gain.changed_blocking(), Err(BlockingError::InsideAsync));
    });
}

#[test]
fn a_component_that_hangs_is_told() {
    let (folder, options) = folder();
    let runtime = || tokio::runtime::Builder::new_current_thread().enable_all().build().expect("a runtime");
    let (of_program, of_tool) = (runtime(), runtime());
    let tuner = of_program.block_on(Tuner::open_with(options)).expect("it opens");
    let system = system(&folder);
    let asked = ask_to_set(&system, "tuner", [("gain", "2")], Duration::from_millis(300));
    let error = of_tool.block_on(asked).expect_err("nobody drives the program's runtime").to_string();
    assert!(error.starts_with("component `tuner` did not answer within 300ms: it hangs"), "{error}");
    assert_eq!(tuner.parameters.gain.get(), 0.8);
}

#[tokio::test]
async fn a_component_without_live_parameters_has_no_socket() -> Result<()> {
    let (folder, options) = folder();
    let fixed = Fixed::open_with(options).await?;
    assert!(!folder.path().join("live/fixed.set").exists());
    assert_eq!(values(&system(&folder), "fixed"), Some(vec![("pin".to_owned(), "4".to_owned())]));
    let asked = ask_to_set(&system(&folder), "fixed", [("pin", "2")], Duration::from_millis(1)).await;
    let expected = "component `fixed` did not answer within 1ms: it hangs, does not run, or has no live parameters";
    assert_eq!(asked.expect_err("nobody listens").to_string(), expected);
    drop(fixed);
    Ok(())
}

#[tokio::test]
async fn the_socket_and_the_values_come_back_with_the_folder() -> Result<()> {
    let (folder, options) = folder();
    let tuner = Tuner::open_with(options).await?;
    ask(&folder, &[("gain", "2")]).await?;
    std::fs::remove_dir_all(folder.path().join("live")).expect("it is removed");
    // Waits until the socket is back.
    ask(&folder, &[("mode", "full-auto")]).await?;
    let mut found = None;
    while found.is_none() {
        found = values(&system(&folder), "tuner");
        tokio::task::yield_now().await;
    }
    assert_eq!((value(&folder, "gain"), value(&folder, "mode")), ("2".to_owned(), "full-auto".to_owned()));
    drop(tuner);
    Ok(())
}

#[tokio::test]
async fn an_untyped_component_follows_changes() -> Result<()> {
    use scl::plan::ParameterValue::{Float, Integer};
    let (folder, options) = folder();
    let plan = crate::untyped::system_plan("live.yaml").component("tuner").expect("a component").clone();
    let tuner = scl::untyped::Component::open_with(&plan, options).await?;
    assert_eq!((tuner.parameter_changes(), tuner.parameter("gain")), (0, Some(Float(0.8))));
    ask(&folder, &[("gain", "2"), ("mode", "full-auto")]).await?;
    assert_eq!((tuner.parameter_changes(), tuner.parameter("gain")), (1, Some(Float(2.0))));
    tuner.set_parameter("gain", "3").expect("it is set");
    assert!(matches!(tuner.set_parameter("pin", "3"), Err(SetError::Fixed { parameter: "pin", .. })));
    let values = (tuner.parameter_changes(), tuner.parameter("gain"), tuner.parameter("pin"));
    assert_eq!(values, (2, Some(Float(3.0)), Some(Integer(4))));
    Ok(())
}

#[tokio::test]
async fn an_untyped_component_waits_for_a_change() -> Result<()> {
    let (_folder, options) = folder();
    let plan = crate::untyped::system_plan("live.yaml").component("tuner").expect("a component").clone();
    let tuner = scl::untyped::Component::open_with(&plan, options).await?;
    let mut changed = std::pin::pin!(tuner.parameters_changed(0));
    let pending = std::future::poll_fn(|cx| std::task::Poll::Ready(changed.as_mut().poll(cx).is_pending())).await;
    assert!(pending, "nothing has changed");
    tuner.set_parameter("gain", "2").expect("it is set");
    assert_eq!(changed.await, Ok(1));
    assert_eq!(tuner.parameters_changed(0).await, Ok(1), "it has changed before");
    let changed = tokio::spawn(tuner.parameters_changed(1));
    tokio::task::yield_now().await;
    drop(tuner);
    assert_eq!(changed.await.expect("it has ended"), Err(scl::BlockingError::Closed));
    Ok(())
}
