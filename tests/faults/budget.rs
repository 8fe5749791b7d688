//! Memory on a device whose heaps are full.

use crate::driver::Driver;
use selvedge::gpu::{BudgetOwner, Buffer, GpuError, LowerLimits, Pool};
use selvedge::headless::{HeadlessDevice, HeadlessOptions};

/// An object is refused, but not one that has room in a block of memory that was taken before.
#[test]
fn what_has_room_in_a_block_is_not_refused() {
    const MIB: u64 = 1 << 20;
    let driver = Driver::new(true);
    driver.tell_heaps(false);
    let device = HeadlessDevice::of_entry(driver.entry(), &HeadlessOptions::default(), LowerLimits::NONE).unwrap();
    let make = |name, bytes| Buffer::storage(device.device(), Pool::Transient, name, bytes);
    let first = make("first", MIB).unwrap();
    let taken = device.device().memory_report().taken;
    driver.tell_heaps(true);
    driver.plan(None);
    let second = make("second", MIB).expect("its block has room");
    assert_eq!((device.device().memory_report().taken, driver.calls().get("vkAllocateMemory")), (taken, None));
    let refused = make("third", taken).unwrap_err();
    assert!(matches!(&refused, GpuError::OverBudget { of: BudgetOwner::Heap, left: 0, .. }), "{refused}");
    assert_eq!(driver.calls().get("vkAllocateMemory"), None, "refused before it is allocated");
    driver.tell_heaps(false);
    let third = make("third", taken).expect("the heaps have room again");
    assert!(device.device().memory_report().taken > taken);
    drop((first, second, third));
    drop(device);
    assert!(driver.living().is_empty(), "{:?}", driver.living());
}

/// A host's budget above what the heaps have left does not let more through: the smaller of both holds.
#[test]
fn a_hosts_budget_holds_beside_the_heaps() {
    const MIB: u64 = 1 << 20;
    let driver = Driver::new(true);
    driver.tell_heaps(false);
    let options = HeadlessOptions { memory_budget: Some(256 * MIB), ..HeadlessOptions::default() };
    let device = HeadlessDevice::of_entry(driver.entry(), &options, LowerLimits::NONE).unwrap();
    let make = |name, bytes| Buffer::storage(device.device(), Pool::Transient, name, bytes);
    let first = make("first", MIB).unwrap();
    let taken = device.device().memory_report().taken;
    assert!(2 * taken + MIB < 256 * MIB, "{taken} bytes: the next objects are within the budget");
    driver.tell_heaps(true);
    driver.plan(None);
    let second = make("second", MIB).expect("its block has room");
    let refused = make("third", taken).unwrap_err();
    assert!(matches!(&refused, GpuError::OverBudget { of: BudgetOwner::Heap, left: 0, .. }), "{refused}");
    assert_eq!(driver.calls().get("vkAllocateMemory"), None, "refused before it is allocated");
    drop((first, second));
    drop(device);
    assert!(driver.living().is_empty(), "{:?}", driver.living());
}
