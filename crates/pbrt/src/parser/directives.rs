//! Every directive of pbrt-v4.

use super::Parser;
use super::args::shown;
use crate::directive::{
    ActiveTransform, AttributeTarget, Directive, DirectiveKind as D, Entity, EntityKind, OptionValue,
    Texture, TextureValue,
};
use crate::error::{Error, ErrorKind};
use crate::keyword::{self, Keyword as K, Side};
use crate::params::Owner;
use crate::span::Span;
use crate::text::Text;
use crate::token::{Token, TokenKind};

impl Parser {
    /// Reads the directive that starts with `token`; none if it is `Include`, whose text follows.
    pub(super) fn directive(&mut self, token: Token) -> Result<Option<Directive>, Error> {
        if token.kind != TokenKind::Word {
            return Err(self.not_a_directive(token));
        }
        let Some((name, keyword, side)) = K::find(self.lexer.bytes(token)) else {
            return Err(self.not_a_directive(token));
        };
        let span = token.span;
        self.check_side(name, side, span)?;
        let kind = match keyword {
            K::Include => return self.include(span).map(|()| None),
            K::Import => self.import(span)?,
            K::Entity(kind) => self.entity(name, kind, span)?,
            K::Attribute => self.attribute(span)?,
            K::Texture => self.texture(span)?,
            K::TransformBegin | K::TransformEnd | K::AttributeBegin | K::AttributeEnd => {
                self.attribute_block(name, keyword, span)?
            }
            K::ObjectBegin | K::ObjectEnd | K::ObjectInstance => self.object(name, keyword, span)?,
            K::WorldBegin => self.blocks.begin_world(D::WorldBegin),
            K::ReverseOrientation => D::ReverseOrientation,
            K::Identity => D::Identity,
            K::NamedMaterial => D::NamedMaterial(self.string(name, "the name of a material")?),
            K::ColorSpace => D::ColorSpace(self.string(name, "the name of a colour space")?),
            K::CoordinateSystem => D::CoordinateSystem(self.string(name, "a name in quotes")?),
            K::CoordSysTransform => D::CoordSysTransform(self.string(name, "a name in quotes")?),
            K::MediumInterface => self.medium_interface()?,
            K::Option => self.option()?,
            K::ActiveTransform => self.active_transform()?,
            K::Translate => D::Translate(self.numbers(name)?),
            K::Scale => D::Scale(self.numbers(name)?),
            K::Rotate => D::Rotate(self.numbers(name)?),
            K::LookAt => D::LookAt(self.numbers(name)?),
            K::TransformTimes => D::TransformTimes(self.numbers(name)?),
            K::Transform => D::Transform(self.matrix(name)?),
            K::ConcatTransform => D::ConcatTransform(self.matrix(name)?),
        };
        Ok(Some(Directive { span, kind }))
    }

    fn not_a_directive(&self, token: Token) -> Error {
        if token.kind != TokenKind::Word {
            return self.unexpected("scene", "a directive", Some(token));
        }
        let name = shown(&self.lexer, token).trim_matches('`').to_string();
        let hint = keyword::hint_for(&name);
        Error::new(ErrorKind::UnknownDirective { name }, self.place(token.span)).maybe_hint(hint)
    }

    fn check_side(&self, directive: &'static str, side: Side, span: Span) -> Result<(), Error> {
        let (side, other, hint) = match (side, self.blocks.in_world()) {
            _ if self.fragment => return Ok(()),
            (Side::Before, true) if directive == "WorldBegin" => {
                let problem = "the world has begun already".to_string();
                return Err(Error::new(ErrorKind::Nesting { directive, problem }, self.place(span)));
            }
            (Side::Before, true) => {
                ("before", "after", "it describes the whole picture; move it to the top of the scene")
            }
            (Side::After, false) => ("after", "before", "it describes the world; is WorldBegin missing?"),
            _ => return Ok(()),
        };
        Err(Error::new(ErrorKind::WrongBlock { directive, side, other }, self.place(span)).hint(hint))
    }

    fn entity(&mut self, directive: &'static str, kind: EntityKind, span: Span) -> Result<D, Error> {
        let name = self.string(directive, "a name in quotes")?;
        match kind {
            EntityKind::MakeNamedMaterial => self.define("named material", &name)?,
            EntityKind::MakeNamedMedium => self.define("named medium", &name)?,
            _ => {}
        }
        let params = self.params(Owner { directive, name: name.as_str().into(), span })?;
        Ok(D::Entity(Entity { kind, name, params }))
    }

    fn attribute(&mut self, span: Span) -> Result<D, Error> {
        let expected = "\"shape\", \"light\", \"material\", \"medium\" or \"texture\"";
        let name = self.string("Attribute", expected)?;
        let target = AttributeTarget::NAMES.iter().find(|(n, _)| *n == name.as_str());
        let Some(&(_, target)) = target else {
            let hint = keyword::did_you_mean(&name, AttributeTarget::NAMES.iter().map(|(n, _)| *n));
            return Err(self.unexpected_text("Attribute", expected, &name).maybe_hint(hint));
        };
        let params = self.params(Owner { directive: "Attribute", name: name.as_str().into(), span })?;
        Ok(D::Attribute(target, params))
    }

    fn texture(&mut self, span: Span) -> Result<D, Error> {
        let name = self.string("Texture", "a name in quotes")?;
        let expected = "\"float\" or \"spectrum\"";
        let kind = self.string("Texture", expected)?;
        let (value, what) = match kind.as_str() {
            "float" => (TextureValue::Float, "float texture"),
            "spectrum" => (TextureValue::Spectrum, "spectrum texture"),
            "color" => {
                let error = self.unexpected_text("Texture", expected, &kind);
                return Err(error.hint("pbrt-v4's name of the type is \"spectrum\""));
            }
            _ => return Err(self.unexpected_text("Texture", expected, &kind)),
        };
        let class = self.string("Texture", "the class of a texture")?;
        self.define(what, &name)?;
        let params = self.params(Owner { directive: "Texture", name: class.as_str().into(), span })?;
        Ok(D::Texture(Texture { name, value, class, params }))
    }

    fn unexpected_text(&self, context: &str, expected: &str, got: &Text) -> Error {
        let token = Token { kind: TokenKind::Quoted { escaped: false }, span: got.span() };
        self.unexpected(context, expected, Some(token))
    }

    fn define(&mut self, what: &'static str, name: &Text) -> Result<(), Error> {
        self.blocks.define(what, name, &self.sources)
    }

    fn attribute_block(&mut self, name: &'static str, keyword: K, span: Span) -> Result<D, Error> {
        if keyword == K::TransformBegin && !self.warned_transform_block {
            self.warned_transform_block = true;
            self.warn_at(
                span,
                "TransformBegin and TransformEnd are deprecated and act as AttributeBegin and AttributeEnd",
                "write AttributeBegin and AttributeEnd",
            );
        }
        if matches!(keyword, K::TransformBegin | K::AttributeBegin) {
            self.blocks.begin(name, span);
            return Ok(D::AttributeBegin);
        }
        self.blocks.end_attribute(name, span, &self.sources)?;
        Ok(D::AttributeEnd)
    }

    fn object(&mut self, name: &'static str, keyword: K, span: Span) -> Result<D, Error> {
        match keyword {
            K::ObjectBegin => {
                let object = self.string(name, "a name in quotes")?;
                self.blocks.begin_object(name, span, &self.sources)?;
                self.define("object", &object)?;
                Ok(D::ObjectBegin(object))
            }
            K::ObjectEnd => {
                self.blocks.end_object(name, span, &self.sources)?;
                Ok(D::ObjectEnd)
            }
            _ => {
                let object = self.string(name, "the name of an object")?;
                self.blocks.forbid_in_object(name, span, &self.sources)?;
                Ok(D::ObjectInstance(object))
            }
        }
    }

    fn medium_interface(&mut self) -> Result<D, Error> {
        let interior = self.string("MediumInterface", "the name of a medium (\"\" for none)")?;
        let exterior = match self.lexer.peek()? {
            Some(Token { kind: TokenKind::Quoted { .. }, .. }) => {
                self.string("MediumInterface", "the name of a medium")?
            }
            _ => interior.clone(),
        };
        Ok(D::MediumInterface { interior, exterior })
    }

    fn option(&mut self) -> Result<D, Error> {
        let name = self.string("Option", "a name in quotes")?;
        let expected = "a value: true, false, a number or a string";
        let token = self.need("Option", expected)?;
        let value = match token.kind {
            TokenKind::Quoted { escaped } => OptionValue::String(self.text(token, escaped)),
            TokenKind::Word => match self.lexer.bytes(token) {
                b"true" => OptionValue::Bool(true),
                b"false" => OptionValue::Bool(false),
                _ => OptionValue::Number(self.number(name.as_str(), token)?),
            },
            _ => return Err(self.unexpected("Option", expected, Some(token))),
        };
        Ok(D::Option(name, value))
    }

    fn active_transform(&mut self) -> Result<D, Error> {
        let expected = "`StartTime`, `EndTime` or `All`";
        let token = self.need("ActiveTransform", expected)?;
        let which = match self.lexer.bytes(token) {
            b"StartTime" => ActiveTransform::StartTime,
            b"EndTime" => ActiveTransform::EndTime,
            b"All" => ActiveTransform::All,
            _ => return Err(self.unexpected("ActiveTransform", expected, Some(token))),
        };
        Ok(D::ActiveTransform(which))
    }
}
