//! Keeps compiled pipelines in a file from one run to the next.
//!
//! ```text
//!   8 bytes      8 bytes         48 bytes                                               the rest
//!   SELVEDGE │ checksum of │ vendor, device, driver version, cache UUID, driver UUID │ the driver's data
//!            │ the rest    │ 4       4       4, and 4 zeros  16          16           │
//! ```
//!
//! A file that is damaged, foreign, or of another device or driver is ignored: the pipelines are compiled as without
//! it. The file is written under another name and renamed, so no reader sees half of it. Of two writers the last one
//! wins. Rust's standard hasher computes the checksum: if that hasher changes, older files count as damaged.

use ash::vk;
use std::fs::File;
use std::hash::Hasher;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

const MAGIC: &[u8; 8] = b"SELVEDGE";
/// Bytes that identify a device and its driver.
pub(super) const IDENTITY: usize = 48;
/// The most bytes that are read of a file. Drivers keep some ten kilobytes a pipeline.
const MOST_BYTES: u64 = 1 << 28;

/// The file of one device's pipelines.
pub(super) struct PipelineFile {
    path: PathBuf,
    identity: [u8; IDENTITY],
    /// The checksum of the data that was read, or written last.
    known: Option<u64>,
}

/// Identifies a device and its driver.
pub(super) fn identity(instance: &ash::Instance, physical: vk::PhysicalDevice) -> [u8; IDENTITY] {
    let mut ids = vk::PhysicalDeviceIDProperties::default();
    let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut ids);
    // SAFETY: the device belongs to the instance; the struct is part of Vulkan 1.1.
    unsafe { instance.get_physical_device_properties2(physical, &mut properties) };
    let properties = properties.properties;
    let numbers = [properties.vendor_id, properties.device_id, properties.driver_version, 0];
    let mut bytes = [0; IDENTITY];
    bytes[..16].copy_from_slice(bytemuck::cast_slice(&numbers));
    bytes[16..32].copy_from_slice(&properties.pipeline_cache_uuid);
    bytes[32..].copy_from_slice(&ids.driver_uuid);
    bytes
}

fn checksum(bytes: &[u8]) -> u64 {
    let mut hasher = std::hash::DefaultHasher::new();
    hasher.write(bytes);
    hasher.finish()
}

impl PipelineFile {
    /// Opens the file of a device, in a folder that need not exist. Returns the driver's data, empty if the file has
    /// none.
    pub(super) fn open(folder: &Path, identity: [u8; IDENTITY]) -> (Self, Vec<u8>) {
        let path = folder.join(format!("pipelines-{:016x}", checksum(&identity)));
        let data = read(&path, &identity).unwrap_or_default();
        let known = (!data.is_empty()).then(|| checksum(&data));
        (Self { path, identity, known }, data)
    }

    /// Writes the driver's data, unless it is the data that was read or written last.
    pub(super) fn write(&mut self, data: &[u8]) -> io::Result<()> {
        let sum = checksum(data);
        if self.known == Some(sum) {
            return Ok(());
        }
        let folder = self.path.parent().unwrap_or(Path::new("."));
        std::fs::create_dir_all(folder)?;
        // devices of one process may end at the same time
        static NTH: AtomicU64 = AtomicU64::new(0);
        let nth = NTH.fetch_add(1, Ordering::Relaxed);
        let beside = self.path.with_extension(format!("{}.{nth}.new", std::process::id()));
        let body = [&self.identity, data].concat();
        let written = File::create(&beside).and_then(|mut file| {
            file.write_all(MAGIC)?;
            file.write_all(&checksum(&body).to_le_bytes())?;
            file.write_all(&body)?;
            file.sync_all()
        });
        let renamed = written.and_then(|()| std::fs::rename(&beside, &self.path));
        if renamed.is_err() {
            let _ = std::fs::remove_file(&beside); // it may not be there
        }
        renamed?;
        self.known = Some(sum);
        Ok(())
    }
}

/// The driver's data of a file; `None` if the file is missing, damaged or of another device.
fn read(path: &Path, identity: &[u8; IDENTITY]) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path).ok()?.take(MOST_BYTES).read_to_end(&mut bytes).ok()?;
    let body = bytes.strip_prefix(MAGIC)?;
    let (sum, body) = body.split_first_chunk::<8>()?;
    let is_whole = u64::from_le_bytes(*sum) == checksum(body);
    let data = body.strip_prefix(identity)?;
    is_whole.then(|| data.to_vec())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder of this test, empty.
    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("selvedge-pipelines-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&folder);
        folder
    }

    #[test]
    fn a_file_gives_back_what_was_kept_and_no_other() {
        let folder = folder("kept");
        let (ours, other) = ([7; IDENTITY], [8; IDENTITY]);
        let (mut file, none) = PipelineFile::open(&folder, ours);
        assert!(none.is_empty());
        let data: Vec<u8> = (0..=255).collect();
        file.write(&data).unwrap();
        assert_eq!(PipelineFile::open(&folder, ours).1, data);
        assert_eq!(PipelineFile::open(&folder, other).1, [0; 0], "another device has a file of its own");
        let whole = std::fs::read(&file.path).unwrap();
        let keeps = |bytes: &[u8]| {
            std::fs::write(&file.path, bytes).unwrap();
            PipelineFile::open(&folder, ours).1 == data
        };
        assert!(keeps(&whole));
        for end in 0..whole.len() {
            assert!(!keeps(&whole[..end]), "cut off at {end}");
        }
        for at in 0..whole.len() {
            let mut flipped = whole.clone();
            flipped[at] ^= 1 << (at % 8);
            assert!(!keeps(&flipped), "byte {at}");
        }
        assert!(!keeps(&[whole.as_slice(), &[0]].concat()), "longer");
        // what another device's program wrote, under our name
        let (mut foreign, _) = PipelineFile::open(&folder, other);
        foreign.path.clone_from(&file.path);
        foreign.write(&data).unwrap();
        assert_eq!(PipelineFile::open(&folder, ours).1, [0; 0], "another device's data");
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn the_same_is_not_written_twice_and_nothing_is_left_beside() {
        let folder = folder("twice");
        let (mut file, _) = PipelineFile::open(&folder, [1; IDENTITY]);
        file.write(b"compiled").unwrap();
        std::fs::remove_file(&file.path).unwrap();
        file.write(b"compiled").unwrap();
        assert!(!file.path.exists(), "the same data is not written again");
        file.write(b"more").unwrap();
        assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 1, "the file alone");
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn a_folder_that_cannot_be_made_is_an_error() {
        let file = folder("file");
        std::fs::write(&file, b"a file").unwrap();
        let (mut within, none) = PipelineFile::open(&file, [1; IDENTITY]);
        assert!(none.is_empty() && within.write(b"compiled").is_err());
        std::fs::remove_file(&file).unwrap();
    }
}
