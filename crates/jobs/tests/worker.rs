//! Jobs of different cameras have frames in flight; each has the picture or the error that it has alone. Needs a Vulkan
//! driver.

use selvedge::glam::DVec3;
use selvedge::gpu::GpuError;
use selvedge::model::{Camera, Model};
use selvedge::picture::{FrameSettings, Outputs, Picture, SceneSettings};
use selvedge_jobs::{
    Backdrop, Bound, DeviceOptions, Drawer, Drawn, Exceeded, Job, JobError, Limits, ReadOptions, Source, Stop, Ticket,
    Work, Worker, read,
};
use std::path::Path;
use std::sync::Arc;
use std::thread;
use std::time::Duration;

const SIZE: (u32, u32) = (320, 240);

fn bracket() -> Arc<Model> {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../samples/bracket.step"));
    read(Source::Path(path), &ReadOptions::default(), &Stop::default(), &|_| ()).expect("a model").model
}

/// Pictures from around the model.
fn jobs(count: u32) -> Vec<Job> {
    let model = bracket();
    let job = |nth: u32| {
        let (sin, cos) = (0.5 * f64::from(nth)).sin_cos();
        Job {
            model: Arc::clone(&model),
            camera: Camera::framing(&model, DVec3::new(cos, sin, 0.6), DVec3::Z, 0.6, SIZE),
            scene: SceneSettings::default(),
            frame: FrameSettings::default(),
            outputs: Outputs::ALL,
            backdrop: Backdrop::Gradient,
            limits: Limits::default(),
        }
    };
    (0..count).map(job).collect()
}

/// Each by itself.
fn alone(jobs: &[Job]) -> Vec<Drawn> {
    let mut drawer = Drawer::new(&DeviceOptions::default()).expect("a device");
    jobs.iter().map(|job| drawer.draw(job, &Stop::default()).expect("a picture")).collect()
}

fn submitted(worker: &Worker, jobs: &[Job]) -> Vec<Ticket> {
    jobs.iter().map(|job| worker.submit(job.clone()).expect("the worker takes it")).collect()
}

fn answer(ticket: &Ticket) -> Result<Drawn, JobError> {
    ticket.wait(Duration::from_secs(60)).expect("an answer within a minute")
}

/// Compares everything except costs.
fn assert_same(drawn: &Drawn, expected: &Drawn, what: &str) {
    let bits = |drawn: &Drawn| {
        let Picture { size, colour, depth, face, uv, normal, .. } = &drawn.picture;
        let uv: Vec<_> = uv.iter().map(|uv| uv.map(f32::to_bits)).collect();
        let depth: Vec<_> = depth.iter().map(|depth| depth.to_bits()).collect();
        (*size, colour.clone(), depth, face.clone(), uv, normal.clone())
    };
    assert!(expected.picture.face.iter().any(|face| *face != 0), "{what} shows nothing");
    assert!(bits(drawn) == bits(expected), "{what}");
}

/// Bytes of some pools when the picture was there.
fn bytes(drawn: &Drawn, of: impl Fn(&str) -> bool) -> u64 {
    drawn.picture.stats.pools.iter().filter(|pool| of(&pool.name)).map(|pool| pool.bytes).sum()
}

/// Bytes of images and of what a view needs.
fn transient(drawn: &Drawn) -> u64 {
    bytes(drawn, |pool| pool == "transient")
}

#[test]
fn pictures_in_flight_are_those_of_each_alone() {
    let jobs = jobs(8);
    let expected = alone(&jobs);
    let worker = Worker::new(DeviceOptions::default()).expect("a device");
    let draw = |jobs: &[Job]| -> Vec<_> {
        submitted(&worker, jobs).iter().map(|ticket| answer(ticket).expect("a picture")).collect()
    };
    let drawn = draw(&jobs);
    for (nth, (drawn, expected)) in drawn.iter().zip(&expected).enumerate() {
        assert_same(drawn, expected, &format!("picture {nth}"));
        assert!(drawn.draw_s > 0.0 && drawn.upload_s > 0.0);
    }
    // there is room for each view now; the second of two equal pictures frees what the first replaced, and flights end
    // where no order waits
    let rest = || {
        let alone = |_| {
            std::thread::sleep(Duration::from_millis(50));
            draw(&jobs[..1]);
            transient(&draw(&jobs[..1])[0])
        };
        (0..5).map(alone).min()
    };
    let before = rest().expect("pictures");
    let most = draw(&jobs).iter().map(transient).max().expect("pictures");
    let colour = u64::from(SIZE.0) * u64::from(SIZE.1) * 4;
    assert!(most > before + colour, "no two pictures were in flight: {most} bytes, alone {before}");
    assert_eq!(rest(), Some(before), "what further flights had is freed");
}

/// Between jobs that are drawn together: a camera that shows nothing, a job that is stopped, settings that no picture
/// has.
#[test]
fn a_job_that_fails_costs_itself_only() {
    let mut jobs = jobs(9);
    let expected = alone(&jobs);
    jobs[3].camera.target = jobs[3].camera.eye;
    jobs[6].frame.tolerance_px = 0.0;
    let worker = Worker::new(DeviceOptions::default()).expect("a device");
    let tickets = submitted(&worker, &jobs);
    tickets[5].stop(); // the model is still being uploaded
    for (nth, (ticket, expected)) in tickets.iter().zip(&expected).enumerate() {
        match (nth, answer(ticket)) {
            (3, Err(JobError::Camera(_))) | (5, Err(JobError::Stopped)) => {}
            (6, Err(JobError::Draw(error))) => assert!(error.to_string().contains("tolerance"), "{error}"),
            (3 | 5 | 6, Ok(_)) => panic!("picture {nth} was drawn"),
            (_, Ok(drawn)) => assert_same(&drawn, expected, &format!("picture {nth}")),
            (_, Err(error)) => panic!("picture {nth}: {error}"),
        }
    }
    // closed in the middle: what was sent is drawn
    let tickets = submitted(&worker, &jobs[..3]);
    drop(worker);
    for (ticket, expected) in tickets.iter().zip(&expected) {
        assert_same(&answer(ticket).expect("a picture"), expected, "sent before the close");
    }
}

/// Pictures of a file share its time, whichever job spends it; memory is that of the process.
#[test]
fn a_file_beyond_its_limits_costs_itself_only() {
    let hour = Duration::from_secs(3600);
    let mut jobs = jobs(6);
    let expected = alone(&jobs);
    let none = Limits::new("none.step", Some(Duration::ZERO), None);
    let shared = Limits::new("shared.step", Some(hour), None);
    jobs[1].limits = none.clone();
    // enough to be begun, and too little for a picture: it ends while others are in flight
    jobs[2].limits = Limits::new("brief.step", Some(Duration::from_micros(50)), None);
    jobs[3].limits = Limits::new("large.step", None, Some(1));
    jobs[4].limits = shared.clone();
    jobs[5].limits = shared.clone();
    let worker = Worker::new(DeviceOptions::default()).expect("a device");
    let exceeded = |answer: Result<Drawn, JobError>| match answer {
        Err(JobError::Limit(Exceeded { file, work, bound })) => (file, work, bound),
        Err(error) => panic!("{error}"),
        Ok(_) => panic!("a picture beyond the limits"),
    };
    for (nth, (ticket, expected)) in submitted(&worker, &jobs).iter().zip(&expected).enumerate() {
        match (nth, answer(ticket)) {
            (1, answer) => {
                let late = ("none.step".to_owned(), Work::Drawing, Bound::Time(Duration::ZERO));
                assert_eq!(exceeded(answer), late);
            }
            (2, answer) => {
                let late = ("brief.step".to_owned(), Work::Drawing, Bound::Time(Duration::from_micros(50)));
                assert_eq!(exceeded(answer), late);
            }
            (3, answer) => {
                let (file, work, bound) = exceeded(answer);
                let is_memory = matches!(bound, Bound::Memory { most: 1, held: 2.. });
                assert!(file == "large.step" && work == Work::Drawing && is_memory, "{file}: {work:?} {bound:?}");
            }
            (_, answer) => assert_same(&answer.expect("a picture"), expected, &format!("picture {nth}")),
        }
    }
    shared.spend(hour);
    assert_eq!(exceeded(answer(&submitted(&worker, &jobs[4..5])[0])).1, Work::Drawing);
    // another model, which is to be uploaded first
    let other = Job { model: bracket(), limits: none, ..jobs[0].clone() };
    assert_eq!(exceeded(answer(&submitted(&worker, &[other])[0])).1, Work::Preparing);
    assert_same(&answer(&submitted(&worker, &jobs[..1])[0]).expect("a picture"), &expected[0], "after them");
}

#[test]
fn threads_share_a_worker_and_models_outlive_it() {
    let jobs = jobs(4);
    let expected = alone(&jobs);
    let worker = Worker::new(DeviceOptions::default()).expect("a device");
    thread::scope(|scope| {
        for (half, expected) in jobs.chunks(2).zip(expected.chunks(2)) {
            let worker = &worker;
            scope.spawn(move || {
                for _ in 0..3 {
                    for (ticket, expected) in submitted(worker, half).iter().zip(expected) {
                        assert_same(&answer(ticket).expect("a picture"), expected, "a thread's picture");
                    }
                }
            });
        }
    });
    drop(worker);
    let mut other = Worker::new(DeviceOptions::default()).expect("a device");
    let again = answer(&submitted(&other, &jobs[..1])[0]).expect("a picture");
    assert_same(&again, &expected[0], "the picture of another worker");
    other.close();
    assert!(matches!(other.submit(jobs[0].clone()), Err(JobError::Closed)));
}

/// A budget for one picture and a quarter of the images of another. One job needs more by itself.
#[test]
fn pictures_that_do_not_fit_together_are_drawn_alone() {
    let mut jobs = jobs(8);
    let expected = alone(&jobs);
    let pixels = u64::from(SIZE.0) * u64::from(SIZE.1);
    let most = expected.iter().map(|drawn| bytes(drawn, |_| true) + 18 * pixels).max();
    jobs[4].camera.size = (8 * SIZE.0, 8 * SIZE.1);
    let worker = Worker::new(DeviceOptions { memory_budget: most, ..DeviceOptions::default() }).expect("a device");
    for (nth, (ticket, expected)) in submitted(&worker, &jobs).iter().zip(&expected).enumerate() {
        match (nth, answer(ticket)) {
            (4, Err(JobError::Draw(error))) => {
                assert!(error.gpu().is_some_and(GpuError::is_out_of_memory), "{error}");
            }
            (4, Ok(_)) => panic!("the large picture was drawn"),
            (_, Ok(drawn)) => assert_same(&drawn, expected, &format!("picture {nth}")),
            (_, Err(error)) => panic!("picture {nth}: {error}"),
        }
    }
}
