//! Lifetimes of objects, the count of their bytes, and leaks.

use crate::support::{assert_silent, watched};
use ash::vk;
use selvedge::gpu::{
    Binding, BudgetOwner, Buffer, BufferInfo, ComputeInfo, GpuError, Image, ImageInfo, MemoryLocation, Pipeline, Pool,
};
use selvedge::headless::{HeadlessDevice, HeadlessError, HeadlessOptions, Severity};
use selvedge::internals::scan::Scan;
use std::collections::BTreeSet;

#[test]
fn live_objects_are_listed_until_they_go() {
    let device = watched();
    assert_eq!(device.device().objects(), [""; 0]);
    let table = Buffer::storage(device.device(), Pool::Persistent, "trim table", 100).unwrap();
    let scan = Scan::new(device.device(), true).unwrap();
    let objects = device.device().objects();
    assert_eq!(objects[0], "trim table");
    assert!(objects.iter().any(|name| name == "scan blocks"), "{objects:?}");
    drop(table);
    assert!(!device.device().objects().iter().any(|name| name == "trim table"));
    drop(scan);
    assert_eq!(device.device().objects(), [""; 0]);
    assert_silent(device);
}

#[test]
fn bytes_are_counted_in_their_pool() {
    let device = watched();
    let bytes = |pool| device.device().pool_bytes().into_iter().find(|(p, _)| *p == pool).unwrap().1;
    let scene = Buffer::storage(device.device(), Pool::Persistent, "control points", 1 << 20).unwrap();
    let usage = vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT;
    let info =
        ImageInfo { name: "depth", size: (640, 480), format: vk::Format::D32_SFLOAT, usage, pool: Pool::Transient };
    let depth = Image::new(device.device(), &info).unwrap();
    // a driver may round up for alignment, by far less than a tenth at this size
    assert!((1 << 20..(1 << 20) + 100_000).contains(&bytes(Pool::Persistent)));
    assert!((640 * 480 * 4..640 * 480 * 4 * 11 / 10).contains(&bytes(Pool::Transient)));
    assert_eq!(bytes(Pool::Ring), 0);
    drop((scene, depth));
    assert_eq!(device.device().pool_bytes().map(|(_, bytes)| bytes), [0; 4]);
    assert_silent(device);
}

/// A handle that is not destroyed: the layers report it when the device is destroyed.
#[test]
fn a_leaked_handle_is_reported() {
    let device = watched();
    let info = vk::BufferCreateInfo::default().size(64).usage(vk::BufferUsageFlags::STORAGE_BUFFER);
    // SAFETY: the device is alive. The test leaks on purpose.
    unsafe { device.device().raw().create_buffer(&info, None) }.unwrap();
    let messages = device.shutdown();
    let leak = messages.iter().find(|m| m.id.contains("vkDestroyDevice"));
    assert_eq!(leak.map(|m| m.severity), Some(Severity::Error), "{messages:?}");
}

/// A wrapper that outlives its device is named, and the device stays for it.
#[test]
fn a_forgotten_buffer_is_named() {
    let device = watched();
    let buffer = Buffer::storage(device.device(), Pool::Transient, "forgotten", 64).unwrap();
    let messages = device.shutdown();
    assert!(messages.iter().any(|m| m.text.contains("forgotten")), "{messages:?}");
    drop(buffer);
}

#[test]
fn a_buffer_beyond_the_device_is_refused_by_name() {
    let device = watched();
    let limit = u64::from(device.device().limits().max_storage_buffer_range);
    let info = BufferInfo {
        name: "giant",
        bytes: limit + 1,
        usage: Buffer::STORAGE,
        pool: Pool::Transient,
        location: MemoryLocation::Device,
    };
    match Buffer::new(device.device(), &info) {
        Err(GpuError::TooLarge { resource, .. }) => assert_eq!(resource, "giant"),
        other => panic!("{other:?}"),
    }
    assert_silent(device);
}

#[test]
fn an_unknown_device_is_answered_with_those_there_are() {
    let options = HeadlessOptions { device: Some("no such device".to_owned()), ..Default::default() };
    match HeadlessDevice::new(&options) {
        Err(HeadlessError::NoSuchDevice { wanted, present }) => {
            assert_eq!(wanted, "no such device");
            assert!(!present.is_empty());
        }
        Err(error) => panic!("{error}"),
        Ok(_) => panic!("found a device of that name"),
    }
}

/// A machine without a driver, simulated by a child process whose loader finds none.
#[test]
fn a_missing_driver_is_answered_with_what_to_install() {
    let output = std::process::Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "lifetimes::bytes_are_counted_in_their_pool"])
        .envs(["VK_DRIVER_FILES", "VK_ICD_FILENAMES"].map(|name| (name, "/dev/null")))
        .output()
        .unwrap();
    let said = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).concat();
    assert!(!output.status.success(), "{said}");
    assert!(said.contains("apt install mesa-vulkan-drivers"), "{said}");
}

/// Pipelines with one description are one Vulkan object, which exists as long as the last of them; the driver makes it
/// once.
#[test]
fn pipelines_of_one_description_are_one() {
    let watched = watched();
    let device = watched.device();
    let spirv: Vec<u32> = include_bytes!("spirv/coverage.comp.spv")
        .chunks_exact(4)
        .map(|word| u32::from_le_bytes(word.try_into().unwrap()))
        .collect();
    let bindings = [[Binding::TexelBuffer; 3].as_slice(), &[Binding::Storage; 2]].concat();
    let info = ComputeInfo { name: "twice", spirv: &spirv, bindings: &bindings, push_bytes: 8, constants: &[] };
    let named = |name: &str| device.objects().iter().filter(|object| *object == name).count();
    let first = Pipeline::compute(device, &info).unwrap();
    let once = device.pipeline_time();
    assert!(!once.is_zero());
    let copy = spirv.clone();
    let second = Pipeline::compute(device, &ComputeInfo { spirv: &copy, ..info }).unwrap();
    assert_eq!((first.handle(), first.layout()), (second.handle(), second.layout()));
    assert_eq!((named("twice"), device.pipeline_time()), (2, once));
    let other = Pipeline::compute(device, &ComputeInfo { name: "another", ..info }).unwrap();
    assert!(other.handle() != first.handle() && device.pipeline_time() > once);
    drop(first);
    assert_eq!(named("twice"), 1);
    // the validation layer reports it if it is freed too early, twice or never
    let third = Pipeline::compute(device, &info).unwrap();
    assert_eq!(third.handle(), second.handle());
    drop((second, third));
    let before = device.pipeline_time();
    let anew = Pipeline::compute(device, &info).unwrap();
    assert!(device.pipeline_time() > before, "made once more");
    drop((anew, other));
    assert_silent(watched);
}

/// A buffer beyond the budget is refused before it is allocated, and the error has the sizes. After a buffer is freed
/// it fits.
#[test]
fn more_than_the_budget_is_refused_before_it_is_allocated() {
    const MIB: u64 = 1 << 20;
    let options = HeadlessOptions { validation: true, memory_budget: Some(2 * MIB), ..Default::default() };
    let watched = HeadlessDevice::new(&options).unwrap();
    let device = watched.device();
    let make = |name, bytes| Buffer::storage(device, Pool::Transient, name, bytes);
    let first = make("first", MIB).unwrap();
    let taken: u64 = device.pool_bytes().iter().map(|(_, bytes)| bytes).sum();
    let refused = make("second", MIB + MIB / 2).unwrap_err();
    let GpuError::OverBudget { resource, bytes, left, most, of } = &refused else { panic!("{refused}") };
    assert_eq!((resource.as_str(), *left, *most, *of), ("second", 2 * MIB - taken, 2 * MIB, BudgetOwner::Host));
    assert!(*bytes >= MIB + MIB / 2 && refused.is_out_of_memory() && refused.to_string().contains("smaller picture"));
    assert_eq!(device.pool_bytes().iter().map(|(_, bytes)| bytes).sum::<u64>(), taken, "nothing was allocated");
    assert_eq!(device.objects(), ["first"]);
    assert!(device.memory_report().taken <= 2 * MIB, "blocks are no larger than the budget");
    let image = ImageInfo {
        name: "image",
        size: (1024, 1024),
        format: vk::Format::R32_UINT,
        usage: vk::ImageUsageFlags::TRANSFER_SRC,
        pool: Pool::Transient,
    };
    assert!(matches!(Image::new(device, &image), Err(GpuError::OverBudget { .. })), "images are counted, too");
    drop(first);
    drop(make("second", MIB + MIB / 2).expect("there is room now"));
    assert_silent(watched);
}

/// Buffers share blocks of memory. A larger one has a block of its own, which goes with it.
#[test]
fn blocks_are_shared_and_given_back() {
    const BYTES: u64 = 1 << 16;
    let watched = watched();
    let device = watched.device();
    let make = |name, bytes| Buffer::storage(device, Pool::Transient, name, bytes).unwrap();
    let first = make("first", BYTES);
    let one = device.memory_report();
    let more: Vec<_> = (0..50).map(|_| make("more", BYTES)).collect();
    let many = device.memory_report();
    assert_eq!(many.taken, one.taken);
    assert!(one.used >= BYTES && many.used >= 51 * BYTES && many.used <= many.taken, "{many:?}");
    let large = make("large", one.taken + 1);
    assert!(device.memory_report().taken > 2 * one.taken);
    drop(large);
    assert_eq!(device.memory_report(), many);
    drop((first, more));
    let empty = device.memory_report();
    assert_eq!((empty.taken, empty.used), (one.taken, 0), "one block is kept");
    assert_silent(watched);
}

/// Without a host's budget the heap is the limit. The test wants a tebibyte, which devices do not have.
#[test]
fn what_no_heap_has_is_refused() {
    let watched = watched();
    let usage = vk::BufferUsageFlags::TRANSFER_DST;
    let info =
        BufferInfo { name: "giant", bytes: 1 << 40, usage, pool: Pool::Transient, location: MemoryLocation::Device };
    match Buffer::new(watched.device(), &info) {
        Err(GpuError::OverBudget { resource, of: BudgetOwner::Heap, left, most, .. }) => {
            assert!(resource == "giant" && left <= most && most > 0);
        }
        Err(GpuError::OutOfMemory { .. }) => {} // the driver refuses the buffer itself
        other => panic!("{:?}", other.map(|buffer| buffer.bytes())),
    }
    drop(watched);
}

/// Compiled pipelines are stored in a file; a truncated or invalid file is replaced.
#[test]
fn pipelines_are_kept_in_a_file() {
    let folder = std::env::temp_dir().join(format!("selvedge-lifetimes-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    let options =
        HeadlessOptions { validation: true, pipeline_folder: Some(folder.clone()), ..HeadlessOptions::default() };
    let kept = || std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect::<Vec<_>>();
    let run = || {
        let watched = HeadlessDevice::new(&options).unwrap();
        drop(Scan::new(watched.device(), true).unwrap());
        assert_silent(watched);
    };
    run();
    let [file] = kept().try_into().expect("one device, one file");
    let whole = std::fs::read(&file).unwrap();
    run();
    assert_eq!(kept().len(), 1);
    // a driver's data of the same pipelines may differ by some bytes from run to run
    let is_whole = || {
        let file = std::fs::read(&file).unwrap();
        file.starts_with(&whole[..8]) && file.len() > whole.len() * 3 / 4
    };
    std::fs::write(&file, &whole[..whole.len() / 2]).unwrap();
    assert!(!is_whole());
    run();
    assert!(is_whole(), "written anew");
    std::fs::write(&file, b"no pipelines at all").unwrap();
    run();
    assert!(is_whole(), "written anew");
    std::fs::remove_dir_all(&folder).unwrap();
}

/// A process that opens device after device keeps the driver's library loaded.
#[test]
fn the_driver_stays_loaded() {
    let libraries = || {
        let maps = std::fs::read_to_string("/proc/self/maps").unwrap();
        let paths = maps.lines().filter_map(|line| line.split_whitespace().nth(5));
        paths.filter(|path| path.contains(".so")).map(str::to_owned).collect::<BTreeSet<_>>()
    };
    let open = || HeadlessDevice::new(&HeadlessOptions::default()).unwrap();
    drop(open());
    let device = open();
    let alive = libraries();
    drop(device);
    assert!(alive.iter().any(|path| path.contains("libvulkan")), "{alive:?}");
    assert_eq!(alive.difference(&libraries()).count(), 0);
}
