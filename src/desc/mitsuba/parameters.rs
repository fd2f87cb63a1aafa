//! `$name` in attributes: by `-D name=value` on the command line, else by `<default>`.

use crate::desc::suggest;

/// The parameters so far, the longest names first: one name may begin another.
#[derive(Debug, Default)]
pub(super) struct Parameters {
    list: Vec<Parameter>,
}

#[derive(Debug)]
struct Parameter {
    name: String,
    value: String,
    /// Whether the command line gave it and nothing has asked for it.
    unused: bool,
}

/// What replacing may make of a value at most.
const LONGEST: usize = 1 << 20;

impl Parameters {
    /// Those of the command line.
    pub fn new(defines: &[(String, String)]) -> Self {
        let mut parameters = Self::default();
        // The last definition of a name counts.
        for (name, value) in defines.iter().rev() {
            parameters.add(name, value, true);
        }
        parameters
    }

    /// What holds if nothing else has been said before.
    pub fn add_default(&mut self, name: &str, value: &str) {
        self.add(name, value, false);
    }

    fn add(&mut self, name: &str, value: &str, unused: bool) {
        if let Some(parameter) = self.list.iter_mut().find(|p| p.name == name) {
            parameter.unused &= unused;
            return;
        }
        let at = self.list.partition_point(|p| p.name.len() >= name.len());
        let parameter = Parameter {
            name: name.to_owned(),
            value: value.to_owned(),
            unused,
        };
        self.list.insert(at, parameter);
    }

    /// Names that the command line gave in vain.
    pub fn unused(&self) -> impl Iterator<Item = &str> {
        self.list.iter().filter(|p| p.unused).map(|p| p.name.as_str())
    }

    /// A value with the parameters in it replaced, once; `\$` is a dollar sign.
    ///
    /// # Errors
    /// A message and advice, for a parameter that is not there.
    pub fn replace(&mut self, value: &str) -> Result<String, (String, Option<String>)> {
        let mut result = String::new();
        let mut rest = value;
        while let Some(at) = rest.find('$') {
            if rest[..at].ends_with('\\') {
                result.push_str(&rest[..at - 1]);
                result.push('$');
                rest = &rest[at + 1..];
                continue;
            }
            result.push_str(&rest[..at]);
            rest = &rest[at + 1..];
            let Some(parameter) = self.list.iter_mut().find(|p| rest.starts_with(p.name.as_str())) else {
                return Err(self.unknown(rest));
            };
            parameter.unused = false;
            result.push_str(&parameter.value);
            rest = &rest[parameter.name.len()..];
            if result.len() > LONGEST {
                return Err((format!("parameters make this longer than {LONGEST} characters"), None));
            }
        }
        result.push_str(rest);
        Ok(result)
    }

    fn unknown(&self, rest: &str) -> (String, Option<String>) {
        let end = rest
            .find(|c: char| !c.is_alphanumeric() && c != '_')
            .unwrap_or(rest.len());
        let name = &rest[..end];
        let names: Vec<&str> = self.list.iter().map(|p| p.name.as_str()).collect();
        let help = match suggest::closest(name, &names) {
            Some(known) => format!("did you mean `${known}`?"),
            None => format!("give it with `-D {name}=VALUE`, or a <default name=\"{name}\" value=\"...\"/>"),
        };
        (format!("there is no parameter `{name}`"), Some(help))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_are_replaced_the_longest_first() {
        let mut parameters = Parameters::new(&[("spp".into(), "16".into()), ("spp".into(), "32".into())]);
        parameters.add_default("spp", "64");
        parameters.add_default("s", "x");
        parameters.add_default("spp_more", "$s");
        assert_eq!(parameters.replace("a$spp,$s;$spp_more").unwrap(), "a32,x;$s");
        assert_eq!(parameters.replace(r"\$spp $s").unwrap(), "$spp x");
        let (message, help) = parameters.replace("$resolution").unwrap_err();
        assert!(message.contains("`resolution`") && help.unwrap().contains("-D"));
    }

    #[test]
    fn parameters_of_parameters_do_not_explode() {
        let mut parameters = Parameters::default();
        parameters.add_default("a", &"x".repeat(1 << 10));
        assert!(parameters.replace(&"$a".repeat(1 << 12)).is_err());
    }
}
