//! `leg ui`.

mod bridge;
mod link;
mod server;

use crate::board::report;
use crate::connection::LegArgs;
use crate::options::Options;
use crate::output::note;
use leg_base::description::{WITHOUT_HOST, hex};
use leg_base::failure::Failure;
use leg_base::json_object;
use leg_boards::image::workspace_root;
use leg_boards::window_page;
use leg_firmware::host_link::HOST_SCHEMA;
use leg_host::cancel_flag::CancelFlag;
use leg_host::operator::HostIdentity;
use leg_host::transport::Transport;
use leg_rig::settings_text;
use link::{PageHello, PageLink};
use server::PageServer;
use std::fs;
use std::path::{Path, PathBuf};
use std::thread;

/// Where the page is built, in the tree of this program.
const BUILT: &str = "target/window";

/// Shows a leg in the browser, in 3D, to be driven: a simulated one in the page itself, or the one that is named.
///
/// The simulated leg can be loaded, pushed and broken, too; its firmware runs in the page, which needs nothing else. With --port, --can
/// or --on all pages show what that leg reports, and one of them drives it once it is unlocked there. An emulated leg keeps to the
/// clock here. Without these options no leg is looked for.
///
/// The page is built from this tree: the first time takes some minutes. It is served on the loopback address, which is printed;
/// Ctrl-C ends that.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Writes the page into this directory in the place of serving it: one file for any web server, or to be opened from disk.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["page", "http_port", "no_open", "on", "port", "can"])]
    export: Option<PathBuf>,
    /// Serves this page, which --export has written, in the place of building one.
    #[arg(long, value_name = "FILE")]
    page: Option<PathBuf>,
    /// The port of the page on the loopback address; a free one if left out.
    #[arg(
        long,
        value_name = "PORT",
        default_value_t = 0,
        hide_default_value = true
    )]
    http_port: u16,
    /// Opens no browser.
    #[arg(long)]
    no_open: bool,
    #[command(flatten)]
    leg: LegArgs,
}

pub(crate) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    if let Some(directory) = &args.export {
        let page = build(directory)?;
        return options.report(&json_object! { page: &page }, || {
            format!("{}\n", page.display())
        });
    }
    // What may be refused comes before the page is built, which may take minutes.
    let server = PageServer::listen(args.http_port).map_err(|error| {
        Failure::refused(
            format!("cannot listen on port {}: {error}", args.http_port),
            "give another --http-port, or none",
        )
    })?;
    let leg = if args.leg.names_leg() {
        Some(open_leg(&args.leg, options)?)
    } else {
        None
    };
    let page = match &args.page {
        Some(file) => read(file)?,
        None => read(&build(&workspace_root().join(BUILT))?)?,
    };
    let cancel = CancelFlag::set_by_ctrl_c();
    let Some((mut transport, hello)) = leg else {
        show(&server.url(), args, options)?;
        return server.run(page, &cancel).map_err(ended);
    };
    let name = hello.name.clone();
    let pages = PageLink::listen(&server.origin(), hello.clone()).map_err(ended)?;
    show(
        &format!("{}#leg={}", server.url(), pages.url()),
        args,
        options,
    )?;
    let served = cancel.clone();
    thread::spawn(move || {
        if let Err(error) = server.run(page, &served) {
            note(&format!("leg: {}", ended(error)));
        }
    });
    let host = HostIdentity::random().id;
    bridge::run(transport.as_mut(), &pages, hello, host, &cancel).map_err(|error| {
        Failure::failed(
            format!("the connection to {name} is lost: {error}"),
            format!("check the cable, then start `leg ui` again; {WITHOUT_HOST}"),
        )
    })
}

/// The connection to the leg, and what pages are told of it.
fn open_leg(leg: &LegArgs, options: Options) -> Result<(Box<dyn Transport>, PageHello), Failure> {
    let (mut operator, name) = leg.open_in_real_time(options)?;
    let hello = PageHello {
        schema: hex(&HOST_SCHEMA),
        name,
        rig: settings_text::rig_file(&operator.settings()?),
    };
    Ok((operator.into_transport(), hello))
}

/// Prints the address, and opens the browser.
fn show(url: &str, args: &Args, options: Options) -> Result<(), Failure> {
    options.report(&json_object! { url: url }, || format!("{url}\n"))?;
    if !args.no_open
        && let Err(error) = open::that_detached(url)
    {
        note(&format!("leg: no browser was opened ({error}): open {url}"));
    }
    Ok(())
}

fn ended(error: std::io::Error) -> Failure {
    Failure::failed(format!("the page is not served: {error}"), "start it again")
}

fn build(directory: &Path) -> Result<PathBuf, Failure> {
    window_page::export(directory, &mut report).map_err(Failure::from_error)
}

fn read(file: &Path) -> Result<Vec<u8>, Failure> {
    fs::read(file).map_err(|error| {
        Failure::refused(
            format!("cannot read {}: {error}", file.display()),
            "give --page a file that `leg ui --export` has written",
        )
    })
}
