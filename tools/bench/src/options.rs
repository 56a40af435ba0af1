//! The options of all subcommands.

/// What the command line asks for.
#[derive(Debug)]
pub(crate) struct Options {
    pub(crate) faces: usize,
    pub(crate) rounds: usize,
    pub(crate) only: Vec<String>,
    pub(crate) record: bool,
    pub(crate) python: String,
    pub(crate) fast_obj: Option<String>,
}

impl Options {
    pub(crate) fn parse(mut arguments: impl Iterator<Item = String>) -> Result<Options, String> {
        let mut options = Options {
            faces: 1_000_000,
            rounds: 7,
            only: Vec::new(),
            record: false,
            python: "python3".to_owned(),
            fast_obj: None,
        };
        while let Some(name) = arguments.next() {
            let mut value = || arguments.next().ok_or(format!("{name} needs a value"));
            match &*name {
                "--faces" => options.faces = positive(&value()?)?,
                "--rounds" => options.rounds = positive(&value()?)?,
                "--only" => options.only.push(value()?),
                "--python" => options.python = value()?,
                "--fast-obj" => options.fast_obj = Some(value()?),
                "--record" => options.record = true,
                _ => return Err(format!("unknown option {name}")),
            }
        }
        Ok(options)
    }

    /// Whether something of this name takes part: a word that `--only` gives picks among the
    /// names that hold it, and does not concern a list in which none does.
    pub(crate) fn picks(&self, name: &str, list: &[&str]) -> bool {
        let mut concerned = self
            .only
            .iter()
            .filter(|word| list.iter().any(|name| name.contains(word.as_str())))
            .peekable();
        concerned.peek().is_none() || concerned.any(|word| name.contains(word.as_str()))
    }
}

fn positive(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(0) | Err(_) => Err(format!("expected a whole number from 1 on, not {text}")),
        Ok(number) => Ok(number),
    }
}
