//! Values of options in the words of other tools.

use super::{Table, habit};

/// The values that other tools have, by option.
pub(super) static VALUES: [(&str, Table); 8] = [
    (
        "when_full",
        Table::new(&[
            habit(
                "block blocking reliable suspend backpressure keepall pause never await true exactlyonce atleastonce",
                &["wait"],
                "it is called `wait` here, and needs `backpressure: true` at the sender",
            ),
            habit(
                "overwrite besteffort keeplast keeplatest latest ring discardold discardoldest drophead head drop oldest old downstream conflate atmostonce shift",
                &["drop_oldest"],
                "",
            ),
            habit(
                "droptail tail reject ignore discardnew discardnewest newest new upstream keepfirst keepoldest",
                &["drop_newest"],
                "",
            ),
        ]),
    ),
    (
        "undecodable",
        Table::new(&[
            habit("ignore drop discard dropnewest dropoldest continue log warn", &["skip"], ""),
            habit("error raise throw abort stop crash exit panic", &["fail"], ""),
        ]),
    ),
    ("unconnected", Table::new(&[habit("true yes allow allowed on 1 optional intended okay ignore", &["ok"], "")])),
    (
        "latched",
        Table::new(&[
            habit("transientlocal transient persistent retain last", &["true"], ""),
            habit("volatile", &["false"], ""),
        ]),
    ),
    ("queue", Table::new(&[habit(UNLIMITED, &[], "there is no unlimited queue")])),
    ("max_size", Table::new(&[habit(UNLIMITED, &[], "a size is always limited")])),
    ("memory", Table::new(&[habit(UNLIMITED, &[], "without `memory`, a component has no bound")])),
    ("timeout", Table::new(&[habit(UNLIMITED, &[], "a call always ends: there is no unlimited timeout")])),
];

const UNLIMITED: &str = "unlimited infinite infinity :infinity inf none unbounded forever never max all keepall 0 0.0 \
                         1 .inf ∞ false off no disabled notimeout nolimit maxdelay waitforever kforever oswaitforever \
                         portmaxdelay tmofevr duration::max";
