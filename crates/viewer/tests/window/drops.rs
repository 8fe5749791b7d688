//! A file that is dropped on the window, by the protocol of X (XDND, version 5), stands beside the open one.

use super::hand::Display;
use super::scene::Scene;
use super::{PATIENCE, Screen, opened, sample};
use std::path::Path;
use std::time::{Duration, Instant};
use x11rb::CURRENT_TIME;
use x11rb::connection::Connection;
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{
    Atom, ClientMessageEvent, ConnectionExt as _, CreateWindowAux, EventMask, PropMode, SELECTION_NOTIFY_EVENT,
    SelectionNotifyEvent, WindowClass,
};
use x11rb::wrapper::ConnectionExt as _;

/// Drops a file on a window, as a file manager does, and waits until the window has taken it.
fn drop_file(display: &Display, window: &str, file: &Path) {
    let (connection, screen) = x11rb::connect(Some(display.name())).expect("the server");
    let screen = &connection.setup().roots[screen];
    let atom = |name: &str| -> Atom {
        connection.intern_atom(false, name.as_bytes()).expect("sent").reply().expect("an atom").atom
    };
    let (selection, list, copy) = (atom("XdndSelection"), atom("text/uri-list"), atom("XdndActionCopy"));
    let (window, source) = (window.parse().expect("a number"), connection.generate_id().expect("a number"));
    let (visual, none) = (screen.root_visual, CreateWindowAux::new());
    let made =
        connection.create_window(0, source, screen.root, 0, 0, 1, 1, 0, WindowClass::INPUT_OUTPUT, visual, &none);
    made.expect("sent").check().expect("a window");
    connection.set_selection_owner(source, selection, CURRENT_TIME).expect("sent").check().expect("owned");
    let tell = |what: &str, [a, b, c, d]: [u32; 4]| {
        let message = ClientMessageEvent::new(32, window, atom(what), [source, a, b, c, d]);
        connection.send_event(false, window, EventMask::NO_EVENT, message).expect("sent").check().expect("told");
    };
    tell("XdndEnter", [5 << 24, list, 0, 0]);
    tell("XdndPosition", [0, (450 << 16) | 280, CURRENT_TIME, copy]);
    let (finished, end) = (atom("XdndFinished"), Instant::now() + PATIENCE);
    loop {
        match connection.poll_for_event().expect("events") {
            Some(Event::SelectionRequest(asked)) => {
                let uri = format!("file://{}\r\n", file.display());
                let put = connection.change_property8(
                    PropMode::REPLACE,
                    asked.requestor,
                    asked.property,
                    asked.target,
                    uri.as_bytes(),
                );
                put.expect("sent").check().expect("changed");
                let answer = SelectionNotifyEvent {
                    response_type: SELECTION_NOTIFY_EVENT,
                    sequence: 0,
                    time: asked.time,
                    requestor: asked.requestor,
                    selection: asked.selection,
                    target: asked.target,
                    property: asked.property,
                };
                let sent = connection.send_event(false, asked.requestor, EventMask::NO_EVENT, answer);
                sent.expect("sent").check().expect("told");
                tell("XdndDrop", [0, CURRENT_TIME, 0, 0]);
            }
            Some(Event::ClientMessage(message)) if message.type_ == finished => return,
            Some(_) => {}
            None => std::thread::sleep(Duration::from_millis(5)),
        }
        assert!(Instant::now() < end, "the window never takes the file");
    }
}

#[test]
fn a_dropped_file_stands_beside_the_open_one() {
    let Some(screen) = Screen::open((900, 560)) else { return };
    let display = &screen.display;
    let (folder, mut program, first) = opened(display, "bracket.step");
    let path = |name: &str| folder.path().join(name);
    std::fs::copy(sample("panel.step"), path("panel.step")).expect("copied");
    let dropped = path("panel.step").canonicalize().expect("a file");
    let eye = first.camera_of(&program.command(display)).eye;
    drop_file(display, &program.id, &dropped);
    program.wait(&format!("read {}", dropped.display()));
    program.wait("uploaded");
    program.rest();
    let title = display.xdotool(&format!("getwindowname {}", program.id));
    assert_eq!(title, "bracket.step, panel.step - selvedge");
    assert_eq!(first.camera_of(&program.command(display)).eye, eye, "the view stays");

    // both are in one scene: parts of either are picked in it
    let mut both = Scene::of(&[path("bracket.step"), path("panel.step")], &program.last("view of "));
    assert!(both.world.model.instances.len() > first.world.model.instances.len());
    program.after(|| display.key("Home"));
    both.camera = both.camera_of(&program.command(display));
    for file in both.world.files.clone() {
        let (at, hit) = both.place(|hit, _| file.instances.contains(&hit.instance));
        display.click(at);
        let selected = program.wait("selected ");
        let wanted = format!("#{} of {}", hit.face, both.world.instance_name(hit.instance));
        assert!(selected.contains(&wanted), "{selected} instead of {wanted}");
        program.rest();
    }
    program.close(display);
}
