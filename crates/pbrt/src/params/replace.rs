//! New values for parameters from outside the scene: the command line, a sweep.

use std::path::Path;
use std::sync::{Arc, Mutex};

use super::{Param, ParamInfo, ParamSet, ParamState, ParamType};
use crate::directive::DirectiveKind;
use crate::error::{Error, ErrorKind};
use crate::load;
use crate::parser::Parser;
use crate::resolve::Resolver;

impl ParamSet {
    /// Gives the parameter `name` the type `kind` and the values that `text` holds, written as in a scene between the
    /// brackets; what was there is marked as ignored. `origin` names the source in messages.
    ///
    /// # Errors
    /// When the text is not a list of values of that type.
    pub fn replace(
        &mut self,
        origin: &str,
        kind: ParamType,
        name: &str,
        text: &str,
    ) -> Result<Arc<ParamInfo>, Error> {
        let directive = format!("Shape \"{name}\" \"{kind} {name}\" [ {text} ]");
        let file = load::load_bytes(&self.sources, origin, directive.into_bytes())?;
        let mut parser = Parser::new(self.sources.clone(), file, Resolver::new(Path::new(""))).fragment();
        let refuse = || {
            let message = format!("{name}: expected values of type `{kind}`, got `{text}`");
            Error::in_file(ErrorKind::Other(message), origin)
        };
        let first = parser.next().ok_or_else(refuse)?.map_err(|_| refuse())?;
        let (DirectiveKind::Entity(entity), None) = (first.kind, parser.next()) else { return Err(refuse()) };
        let [param] = &entity.params.params[..] else { return Err(refuse()) };
        self.mark(name, ParamState::Ignored(format!("replaced by {origin}").into()));
        let old = &param.info;
        let info = Arc::new(ParamInfo {
            name: old.name.clone(),
            kind: old.kind,
            span: old.span,
            value_span: old.value_span,
            count: old.count,
            owner: self.owner.clone(),
            state: Mutex::default(),
        });
        self.params.push(Param { info: info.clone(), inherited: false, color_space: None, ..param.clone() });
        Ok(info)
    }
}

#[cfg(test)]
mod tests {
    use crate::{DirectiveKind, ParamSet, ParamState, ParamType, parse_str};

    fn ball() -> ParamSet {
        let scene = parse_str("ball.pbrt", "WorldBegin Shape \"sphere\" \"float radius\" 2").expect("valid");
        let DirectiveKind::Entity(ball) = &scene.directives[1].kind else { panic!("a shape") };
        ball.params.clone()
    }

    #[test]
    fn the_new_value_counts_and_the_old_one_is_ignored() {
        let mut params = ball();
        let old = params.find("radius").expect("there").info.clone();
        let new = params.replace("--set", ParamType::Float, "radius", "3").expect("a number");
        assert_eq!(params.float("radius", 1.0).expect("a float"), 3.0);
        assert_eq!(new.state(), ParamState::Consumed);
        assert!(matches!(old.state(), ParamState::Ignored(_)));
        assert!(params.unused().is_empty());
    }

    #[test]
    fn errors_name_the_origin() {
        let mut params = ball();
        params.replace("--set ball.radius=-3", ParamType::Float, "radius", "-3").expect("a number");
        let text = params.error_at("radius", "must be > 0", "-3").to_string();
        assert!(text.starts_with("--set ball.radius=-3:"), "{text}");
    }

    #[test]
    fn what_is_no_list_of_values_is_refused() {
        for text in ["", "x", "1 ] \"float zmax\" [ 2", "1 ] Shape \"disk", "\"a", "nan"] {
            let mut params = ball();
            let result = params.replace("--set", ParamType::Float, "radius", text);
            let usable = result.is_ok() && params.float("radius", 1.0).is_ok();
            assert!(!usable, "{text:?}");
        }
    }
}
