//! What the chassis makes of the reports of its wheels.

use rover_system::WheelInstance;
use rover_system::chassis::Reports;

#[test]
fn all_wheels_have_to_report() {
    let mut reports = Reports::default();
    let (last, others) = WheelInstance::ALL.split_last().expect("wheels");
    for wheel in others {
        assert!(!reports.add(*wheel) && !reports.are_complete());
    }
    assert!(reports.add(*last) && reports.are_complete());
    assert!(!reports.add(*last), "it has reported before");
}

#[test]
fn after_a_missing_report_all_begin_again() {
    let mut reports = Reports::default();
    assert!(!reports.begin_again());
    for wheel in WheelInstance::ALL {
        reports.add(*wheel);
    }
    assert!(reports.begin_again() && !reports.are_complete());
}
