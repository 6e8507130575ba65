//! The arguments of `topology!(..)`.

use proc_macro2::{Span, TokenStream, TokenTree};
use scl_text::size::{self, SizeError};
use scl_topology::diagnostic::Diagnostic;
use scl_topology::external::BAD_ARGUMENTS;
use syn::parse::{Parse, ParseStream};
use syn::punctuated::Punctuated;
use syn::{Ident, LitBool, LitStr, Token, bracketed};

/// The parsed arguments.
pub(crate) struct Arguments {
    /// `$crate` of the crate `scl`, under whatever name the user depends on it.
    pub(crate) krate: TokenTree,
    /// The path of the topology file.
    pub(crate) path: LitStr,
    /// `only = [sensor, controller]`.
    pub(crate) only: Option<Vec<Ident>>,
    /// `max_size = "8MiB"`, in bytes.
    pub(crate) max_size: Option<u64>,
    /// `testable = true`: the functions for unit tests exist in every build, also for other crates.
    pub(crate) testable: Option<bool>,
}

impl Arguments {
    /// Parses the tokens from the wrapper macro in `scl`: `$crate`, a comma, then the user's tokens. Returns a
    /// diagnostic and its span if they cannot be parsed.
    pub(crate) fn parse(input: TokenStream) -> Result<Self, (Box<Diagnostic>, Span)> {
        syn::parse2(input).map_err(|error| (Box::new(diagnose(&error)), error.span()))
    }
}

impl Parse for Arguments {
    fn parse(input: ParseStream<'_>) -> syn::Result<Self> {
        let krate = input.parse()?;
        input.parse::<Token![,]>()?;
        let path = parse_path(input)?;
        let mut arguments = Arguments { krate, path, only: None, max_size: None, testable: None };
        while !input.is_empty() {
            input.parse::<Token![,]>().map_err(|error| syn::Error::new(error.span(), NOT_ONE_LITERAL))?;
            if !input.is_empty() {
                arguments.parse_option(input)?;
            }
        }
        Ok(arguments)
    }
}

const NOT_ONE_LITERAL: &str = "expected one string literal with the path of the topology file";

fn parse_path(input: ParseStream<'_>) -> syn::Result<LitStr> {
    let path = input.parse::<LitStr>().map_err(|error| syn::Error::new(error.span(), NOT_ONE_LITERAL))?;
    if path.value().trim().is_empty() {
        return Err(syn::Error::new(path.span(), "the path of the topology file is empty"));
    }
    Ok(path)
}

impl Arguments {
    fn parse_option(&mut self, input: ParseStream<'_>) -> syn::Result<()> {
        let name: Ident = input.parse().map_err(|error| syn::Error::new(error.span(), "expected an option"))?;
        let is_repeated = match name.to_string().as_str() {
            "only" => self.only.replace(parse_only(input)?).is_some(),
            "testable" => self.testable.replace(parse_testable(input)?).is_some(),
            "max_size" => self.max_size.replace(parse_max_size(input)?).is_some(),
            other => return Err(syn::Error::new(name.span(), format!("unknown option `{other}`"))),
        };
        if is_repeated {
            return Err(syn::Error::new(name.span(), format!("the option `{name}` is given twice")));
        }
        Ok(())
    }
}

fn parse_only(input: ParseStream<'_>) -> syn::Result<Vec<Ident>> {
    input.parse::<Token![=]>()?;
    let list;
    bracketed!(list in input);
    Ok(Punctuated::<Ident, Token![,]>::parse_terminated(&list)?.into_iter().collect())
}

fn parse_testable(input: ParseStream<'_>) -> syn::Result<bool> {
    input.parse::<Token![=]>()?;
    Ok(input.parse::<LitBool>()?.value)
}

fn parse_max_size(input: ParseStream<'_>) -> syn::Result<u64> {
    input.parse::<Token![=]>()?;
    let literal: LitStr = input.parse()?;
    let text = literal.value();
    size::parse(&text).map_err(|error| syn::Error::new(literal.span(), bad_size(&text, error)))
}

fn bad_size(text: &str, error: SizeError) -> String {
    match error {
        SizeError::Malformed => match size::suggestions(text).as_slice() {
            [] => format!("`{text}` is not a size; write a whole number and a unit, for example `8MiB`"),
            likely => format!("`{text}` is not a size; write `{}`", likely.join("` or `")),
        },
        SizeError::Negative | SizeError::TooLarge => format!("the size `{text}` is out of range"),
    }
}

fn diagnose(error: &syn::Error) -> Diagnostic {
    BAD_ARGUMENTS
        .without_place(error.to_string())
        .help("write `scl::topology!(\"topology.yaml\")`")
        .note("the options are `only = [sensor, controller]`, `max_size = \"8MiB\"` and `testable = true`")
        .note("`concat!` and `env!` are not expanded before a proc macro sees them")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn good_arguments_are_parsed() {
        let input = r#"scl, "a.yaml", only = [sensor, controller], max_size = "8MiB", testable = true,"#;
        let Ok(arguments) = Arguments::parse(input.parse().unwrap()) else { panic!("refused") };
        assert_eq!(arguments.path.value(), "a.yaml");
        assert_eq!((arguments.max_size, arguments.testable), (Some(8 * 1024 * 1024), Some(true)));
        let only: Vec<String> = arguments.only.unwrap().iter().map(Ident::to_string).collect();
        assert_eq!(only, ["sensor", "controller"]);
    }

    #[test]
    fn bad_arguments_are_refused() {
        let cases = [
            ("scl,", NOT_ONE_LITERAL),
            ("scl, topology.yaml", NOT_ONE_LITERAL),
            (r#"scl, concat!("a", "b")"#, NOT_ONE_LITERAL),
            (r#"scl, "a" "b""#, NOT_ONE_LITERAL),
            (r#"scl, 7"#, NOT_ONE_LITERAL),
            (r#"scl, """#, "the path of the topology file is empty"),
            (r#"scl, "a", nly = [b]"#, "unknown option `nly`"),
            (r#"scl, "a", only = [b], only = [c]"#, "the option `only` is given twice"),
            (r#"scl, "a", testable = yes"#, "expected boolean literal"),
            (r#"scl, "a", max_size = "8 MB""#, "`8 MB` is not a size; write `8MiB`"),
            (r#"scl, "a", max_size = "65536""#, "`65536` is not a size; write `65536B` or `64KiB`"),
            (
                r#"scl, "a", max_size = "huge""#,
                "`huge` is not a size; write a whole number and a unit, for example `8MiB`",
            ),
            (r#"scl, "a", max_size = "99999999999GiB""#, "the size `99999999999GiB` is out of range"),
            (r#"scl, "a", max_size = "-1B""#, "the size `-1B` is out of range"),
        ];
        for (input, message) in cases {
            let Err((problem, _)) = Arguments::parse(input.parse().unwrap()) else { panic!("accepted {input}") };
            assert_eq!((problem.code(), problem.message.as_str()), ("SCL0005", message), "{input}");
        }
    }
}
