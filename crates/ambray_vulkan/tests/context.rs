//! Devices, buffers and commands on whatever device there is.

mod common;

use std::time::Duration;

use ambray_vulkan::{CommandSet, Context, DeviceOptions, Live, Location, VulkanError, Work, probe};
use ash::vk;
use common::{assert_valid, context};

#[test]
fn probing_numbers_devices_as_options_name_them() {
    let Some(context) = context() else { return };
    let devices = probe().unwrap();
    assert!(devices.contains(context.report()));
    for (i, device) in devices.iter().enumerate() {
        assert_eq!(device.number, i);
        assert!(!device.name.is_empty() && device.memory > 0, "{device:?}");
        if device.is_usable() {
            let named = DeviceOptions { device: Some(i.to_string()), ..DeviceOptions::default() };
            assert_eq!(Context::new(&named).unwrap().report(), device);
        }
    }
    let unknown = DeviceOptions { device: Some("no such device".into()), ..DeviceOptions::default() };
    assert!(matches!(Context::new(&unknown), Err(VulkanError::UnknownDevice { .. })));
}

#[test]
fn content_survives_the_way_to_the_device_and_back() {
    let Some(context) = context() else { return };
    // More than one chunk of the staging buffer, and not a multiple of it.
    let content: Vec<u32> = (0..(64 << 18) + 12_345).collect();
    {
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_SRC;
        let buffer =
            context.upload("content", usage | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS, &content).unwrap();
        assert_ne!(buffer.address(), 0);
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let back = context.buffer("back", buffer.size(), usage, Location::Readback).unwrap();
        context
            .run(|recorder| {
                recorder.copy(&buffer, 0, &back, 0, buffer.size());
                recorder.barrier(Work::Transfer, Work::HostRead);
                Ok(())
            })
            .unwrap();
        assert!(back.read::<u32>(0, content.len()) == content);
        assert_eq!(back.read::<u32>(40, 2), [10, 11]);
        assert_eq!(context.live().buffers, 2);
        let empty = context.upload::<u32>("empty", usage, &[]).unwrap();
        assert_eq!(empty.size(), 0);
    }
    assert_eq!(context.live(), Live::default());
    assert_valid(&context);
}

#[test]
fn too_much_memory_is_an_error_that_names_the_buffer() {
    let Some(context) = context() else { return };
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let error = context.buffer("the heap and more", 1 << 60, usage, Location::Device).unwrap_err();
    assert!(matches!(error, VulkanError::OutOfMemory { bytes, .. } if bytes == 1 << 60), "{error:?}");
    assert!(error.to_string().contains("the heap and more"), "{error}");
    assert_eq!(context.live(), Live::default());
    assert_valid(&context);
}

#[test]
fn command_sets_are_used_again_and_tell_times() {
    let Some(context) = context() else { return };
    let usage = vk::BufferUsageFlags::TRANSFER_DST | vk::BufferUsageFlags::TRANSFER_SRC;
    let device = context.buffer("device", 1 << 20, usage, Location::Device).unwrap();
    let back = context.buffer("back", 4, usage, Location::Readback).unwrap();
    let mut commands = CommandSet::new(&context).unwrap();
    for round in 0..3_u32 {
        commands
            .submit(|recorder| {
                recorder.barrier(Work::Transfer, Work::Transfer);
                recorder.fill(&device, round);
                recorder.timestamp("fill");
                recorder.barrier(Work::Transfer, Work::Transfer);
                recorder.copy(&device, 1000, &back, 0, 4);
                recorder.barrier(Work::Transfer, Work::HostRead);
                recorder.timestamp("copy");
                Ok(())
            })
            .unwrap();
        let times = commands.wait().unwrap();
        assert!(commands.is_done().unwrap());
        assert_eq!(times.iter().map(|t| t.label).collect::<Vec<_>>(), ["fill", "copy"]);
        let has_stamps = context.limits().timestamp_bits > 0;
        assert!(times.iter().all(|t| t.duration.is_some() == has_stamps));
        assert!(times.iter().all(|t| t.duration.unwrap_or_default() < Duration::from_secs(60)));
        assert_eq!(back.read::<u32>(0, 1), [round]);
    }
    assert!(commands.submit::<()>(|_| Err(VulkanError::DeviceLost)).is_err());
    // Nothing was submitted, and the set still works.
    assert!(commands.wait().unwrap().is_empty());
    commands
        .submit(|recorder| {
            recorder.fill(&device, 7);
            Ok(())
        })
        .unwrap();
    drop(commands);
    assert_valid(&context);
}

#[test]
fn threads_share_a_context() {
    let Some(context) = context() else { return };
    std::thread::scope(|scope| {
        for thread in 0..4_u32 {
            let context = &context;
            scope.spawn(move || {
                for round in 0..5 {
                    let words = vec![thread * 100 + round; 1000];
                    let usage = vk::BufferUsageFlags::TRANSFER_SRC;
                    let buffer = context.upload("words", usage, &words).unwrap();
                    let usage = vk::BufferUsageFlags::TRANSFER_DST;
                    let back = context.buffer("back", buffer.size(), usage, Location::Readback).unwrap();
                    context
                        .run(|recorder| {
                            recorder.copy(&buffer, 0, &back, 0, 4000);
                            recorder.barrier(Work::Transfer, Work::HostRead);
                            Ok(())
                        })
                        .unwrap();
                    assert_eq!(back.read::<u32>(0, 1000), words);
                }
            });
        }
    });
    assert_eq!(context.live(), Live::default());
    assert_valid(&context);
}

#[test]
fn mistakes_are_noticed() {
    let Some(context) = context() else { return };
    let usage = vk::BufferUsageFlags::TRANSFER_SRC;
    let buffer = context.buffer("not to be filled", 64, usage, Location::Device).unwrap();
    context
        .run(|recorder| {
            recorder.fill(&buffer, 0);
            Ok(())
        })
        .unwrap();
    let messages = context.validation_messages();
    assert!(messages.iter().any(|m| m.contains("vkCmdFillBuffer")), "{messages:?}");
    let usage = vk::BufferUsageFlags::TRANSFER_DST;
    let buffer = context.buffer("filled twice", 64, usage, Location::Device).unwrap();
    // Without a barrier between: what the checks of synchronisation are for.
    let twice = context.run(|recorder| {
        recorder.fill(&buffer, 0);
        recorder.fill(&buffer, 1);
        Ok(())
    });
    twice.unwrap();
    let messages = context.validation_messages();
    assert!(messages.iter().any(|m| m.contains("WRITE-AFTER-WRITE") || m.contains("WRITE_AFTER_WRITE")));
}
