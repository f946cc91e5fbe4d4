//! The image in `tev` while it renders.

use std::net::{TcpStream, ToSocketAddrs};
use std::path::Path;
use std::time::Duration;

use tev_client::{PacketCreateImage, PacketUpdateImage, TevClient};
use tyndall::film::{Film, FilmSpec};

use crate::args::value::ServerAddress;

const CHANNELS: [&str; 3] = ["R", "G", "B"];
/// A display that does not take data for so long is given up.
const PATIENCE: Duration = Duration::from_secs(5);

/// A connection to `tev`. A display that goes away does not stop the render.
pub struct Display {
    client: Option<TevClient>,
    name: String,
}

impl Display {
    /// Opens an image on the display; `None`, with a warning, when nobody listens there.
    pub fn open(address: &ServerAddress, image: &Path, film: &FilmSpec) -> Option<Self> {
        let name = image.display().to_string();
        let opened = connect(address).and_then(|mut client| {
            let [width, height] = film.resolution;
            let image_name = name.as_str();
            client.send(PacketCreateImage {
                image_name,
                grab_focus: false,
                width,
                height,
                channel_names: &CHANNELS,
            })?;
            Ok(client)
        });
        match opened {
            Ok(client) => Some(Self { client: Some(client), name }),
            Err(e) => {
                tracing::warn!("--display-server {address}: {e}; the render goes on without a display");
                None
            }
        }
    }

    /// Sends the image so far.
    pub fn show(&mut self, film: &Film) {
        let Some(client) = &mut self.client else { return };
        let developed = film.develop();
        let bounds = film.spec().bounds;
        let pixels = bounds.area();
        let data: Vec<f32> = developed.mean.iter().take(CHANNELS.len()).flatten().copied().collect();
        let sent = client.send(PacketUpdateImage {
            image_name: self.name.as_str(),
            grab_focus: false,
            channel_names: &CHANNELS,
            channel_offsets: &[0, pixels, 2 * pixels],
            channel_strides: &[1, 1, 1],
            x: bounds.x0,
            y: bounds.y0,
            width: bounds.width(),
            height: bounds.height(),
            data: &data,
        });
        if let Err(e) = sent {
            tracing::warn!("the display went away: {e}");
            self.client = None;
        }
    }
}

fn connect(address: &ServerAddress) -> std::io::Result<TevClient> {
    let mut last = std::io::Error::new(std::io::ErrorKind::NotFound, "the host has no address");
    for socket in (address.host.as_str(), address.port).to_socket_addrs()? {
        match TcpStream::connect_timeout(&socket, PATIENCE) {
            Ok(stream) => {
                stream.set_write_timeout(Some(PATIENCE))?;
                return Ok(TevClient::wrap(stream));
            }
            Err(e) => last = e,
        }
    }
    Err(last)
}
