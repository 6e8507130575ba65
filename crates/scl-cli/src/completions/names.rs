//! The part of the completion scripts that asks the running system for the names of its gates, components and
//! parameters.

use clap::{Arg, Command};
use clap_complete::Shell;
use std::fmt::Write;

/// An argument for which the shell offers names.
struct Place {
    command: String,
    /// `--option`, or `None` for positional arguments.
    option: Option<String>,
    /// Any of `gates`, `components` and `parameters`.
    wanted: Vec<&'static str>,
}

/// Adds the completion of names to a script from `clap_complete`. The scripts for other shells are left unchanged: they
/// complete only commands and options.
pub(super) fn add_names(shell: Shell, command_line: &Command, script: String) -> String {
    let places = places(command_line);
    if places.is_empty() {
        return script;
    }
    match shell {
        Shell::Bash => script + &bash(&places),
        Shell::Zsh => zsh(&places, &script),
        Shell::Fish => script + &fish(&places),
        _ => script,
    }
}

/// The arguments whose values are called GATE, COMPONENT or PARAMETER in the help.
fn places(command_line: &Command) -> Vec<Place> {
    let place = |command: &Command, argument: &Arg| {
        // Without a value name, the help shows the argument's id in capitals.
        let called = argument.get_value_names().map(|names| names.iter().map(|name| name.to_string()).collect());
        let called: Vec<String> = called.unwrap_or_else(|| vec![argument.get_id().as_str().to_uppercase()]);
        let is_called = |word: &str| {
            let words = called.iter().flat_map(|name| name.split(['|', ',', '.', '=']));
            words.into_iter().any(|part| part.trim_end_matches('S') == word)
        };
        let option = argument.get_long().map(|long| format!("--{long}"));
        let wanted = [("GATE", "gates"), ("COMPONENT", "components"), ("PARAMETER", "parameters")].into_iter();
        let wanted: Vec<&str> = wanted.filter(|(word, _)| is_called(word)).map(|(_, wanted)| wanted).collect();
        (!wanted.is_empty()).then(|| Place { command: command.get_name().to_owned(), option, wanted })
    };
    let commands = command_line.get_subcommands();
    commands.flat_map(|command| command.get_arguments().filter_map(move |it| place(command, it))).collect()
}

/// Returns one branch of a shell's `case` for each place: the pattern `command:option`, and which names to ask for.
fn cases(places: &[Place], indent: &str) -> String {
    let mut text = String::new();
    for place in places {
        // Writing to a string cannot fail.
        let option = place.option.as_deref().unwrap_or_default();
        let _ = writeln!(text, "{indent}{}:{option}) wanted=\"{}\" ;;", place.command, place.wanted.join(" "));
    }
    text
}

fn bash(places: &[Place]) -> String {
    format!(
        r#"
# Names of gates, components and parameters, from the running system.
_scl_with_names() {{
    _scl "$@"
    local current=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} wanted="" system="" names="" index
    [[ $COMP_CWORD -lt 2 || $current == -* ]] && return
    [[ $before == --* ]] || before=""
    for ((index = 2; index < COMP_CWORD; index++)); do
        [[ ${{COMP_WORDS[index]}} == --system ]] && system=${{COMP_WORDS[index + 1]}}
    done
    case ${{COMP_WORDS[1]}}:$before in
{}    esac
    [[ $wanted == *gates* ]] && names+=" $("${{COMP_WORDS[0]}}" complete-gates --system "$system" -- "$current" 2>/dev/null)"
    [[ $wanted == *components* ]] &&
        names+=" $("${{COMP_WORDS[0]}}" complete-gates --components --system "$system" -- "$current" 2>/dev/null)"
    [[ $wanted == *parameters* ]] &&
        names+=" $("${{COMP_WORDS[0]}}" complete-gates --parameters --system "$system" -- "$current" 2>/dev/null)"
    [[ -n $wanted ]] && COMPREPLY=($(compgen -W "$names" -- "$current"))
}}
complete -F _scl_with_names -o bashdefault -o default scl
"#,
        cases(places, "        ")
    )
}

/// Adds our function to the script. The script ends with code that registers or calls its function; this code is
/// replaced by code that does so with ours.
fn zsh(places: &[Place], script: &str) -> String {
    let Some((functions, _)) = script.rsplit_once("if [ \"$funcstack[1]\"") else { return script.to_owned() };
    format!(
        r#"{functions}# Names of gates, components and parameters, from the running system.
_scl_with_names() {{
    local wanted="" before=""
    [[ $words[CURRENT-1] == --* ]] && before=$words[CURRENT-1]
    if (( CURRENT > 2 )) && [[ $PREFIX != -* ]]; then
        case $words[2]:$before in
{}        esac
    fi
    if [[ -z $wanted ]]; then
        _scl "$@"
        return
    fi
    local -a names system
    (( $words[(I)--system] && $words[(I)--system] < CURRENT )) && system=(--system "$words[$words[(I)--system]+1]")
    [[ $wanted == *gates* ]] && names+=(${{(f)"$("$words[1]" complete-gates $system -- "$PREFIX" 2>/dev/null)"}})
    [[ $wanted == *components* ]] &&
        names+=(${{(f)"$("$words[1]" complete-gates --components $system -- "$PREFIX" 2>/dev/null)"}})
    [[ $wanted == *parameters* ]] &&
        names+=(${{(f)"$("$words[1]" complete-gates --parameters $system -- "$PREFIX" 2>/dev/null)"}})
    compadd -- $names
}}

if [ "$funcstack[1]" = "_scl" ]; then
    compdef _scl_with_names scl
    _scl_with_names "$@"
else
    compdef _scl_with_names scl
fi
"#,
        cases(places, "            ")
    )
}

fn fish(places: &[Place]) -> String {
    let mut text = String::from(
        r#"
# Names of gates, components and parameters, from the running system.
function __fish_scl_names
    set -l words (commandline -opc)
    set -l system
    if set -l index (contains -i -- --system $words)
        set system --system $words[(math $index + 1)]
    end
    $words[1] complete-gates $argv $system -- (commandline -ct) 2>/dev/null
end
"#,
    );
    for place in places {
        let condition = format!("__fish_seen_subcommand_from {}", place.command);
        let option = place.option.as_deref().map(|option| format!(" -r -l {}", option.trim_start_matches('-')));
        for wanted in &place.wanted {
            let list = match *wanted {
                "gates" => "__fish_scl_names".to_owned(),
                other => format!("__fish_scl_names --{other}"),
            };
            // Writing to a string cannot fail.
            let option = option.as_deref().unwrap_or_default();
            let _ = writeln!(text, "complete -c scl -n \"{condition}\"{option} -f -a \"({list})\"");
        }
    }
    text
}
