// Tests the doctor on other machines, each represented by a folder with the files that Linux would
// have there.
#include <gtest/gtest.h>

#include <cerrno>
#include <filesystem>

#include "cli/doctor/disk.h"
#include "cli/doctor/graphics.h"
#include "cli/doctor/makers.h"
#include "cli/doctor/parts.h"
#include "cli/doctor/ports.h"
#include "cli/doctor/real_time.h"
#include "cli/doctor/sections.h"
#include "cli/doctor/sound.h"
#include "testing/files.h"

namespace dihaptic::doctor::doctor_test {
namespace {

namespace fs = std::filesystem;

/// A simulated machine that has only the files added with put().
class Machine {
  public:
    void put(const std::string& file, const std::string& text) const {
        fs::create_directories(fs::path(root() + file).parent_path());
        folder_.write(file.substr(1), text);
    }
    const std::string& root() const { return folder_.path(); }

  private:
    testing::TemporaryFolder folder_;
};

Finding of(const Findings& all, const std::string& what) {
    for (const Finding& finding : all) {
        if (finding.what == what) return finding;
    }
    ADD_FAILURE() << "nothing about " << what;
    return {};
}

std::string commands(const Finding& finding) {
    std::string out;
    for (const std::string& command : finding.commands) out += command + "\n";
    return out;
}

bool all_open(const std::string&) {
    return true;
}
bool none_open(const std::string&) {
    return false;
}

/// A laboratory computer on which everything is as it should be.
class GoodMachine : public Machine {
  public:
    GoodMachine() {
        put("/proc/sys/kernel/osrelease", "6.1.0-18-rt-amd64\n");
        put("/proc/version", "Linux version 6.1.0-18-rt-amd64 #1 SMP PREEMPT_RT Debian\n");
        put("/sys/kernel/realtime", "1\n");
        put("/proc/cpuinfo", "flags\t\t: fpu vme\n");
        put("/dev/cpu_dma_latency", "");
        for (const char* cpu : {"cpu0", "cpu1"})
            put(std::string("/sys/devices/system/cpu/") + cpu + "/cpufreq/scaling_governor",
                "performance\n");
    }
};

Rights all_rights() {
    Rights out;
    out.priority = 80;
    out.unlimited_memory = true;
    out.user = "ada";
    out.groups = {"ada", "haptics"};
    out.processors = 8;
    return out;
}

Rights no_rights() {
    Rights out = all_rights();
    out.refusals = {.priority = EPERM, .memory = ENOMEM, .awake = EACCES};
    out.unlimited_memory = false;
    out.groups = {"ada"};
    return out;
}

TEST(Doctor, FindsNothingToMendOnAGoodMachine) {
    const GoodMachine machine;
    for (const Finding& finding : real_time(machine.root(), all_rights())) {
        EXPECT_EQ(finding.verdict, Verdict::ok) << finding.what << ": " << finding.found;
        EXPECT_TRUE(finding.commands.empty()) << finding.what;
    }
}

TEST(Doctor, KnowsAKernelThatKeepsTimeByItsVersionToo) {
    const GoodMachine machine;
    fs::remove(machine.root() + "/sys/kernel/realtime");
    EXPECT_EQ(of(real_time(machine.root(), all_rights()), "kernel").verdict, Verdict::ok);
    machine.put("/proc/version", "Linux version 6.1.0-18-amd64 #1 SMP PREEMPT_DYNAMIC Debian\n");
    const Finding kernel = of(real_time(machine.root(), all_rights()), "kernel");
    EXPECT_EQ(kernel.verdict, Verdict::lacks);
    EXPECT_EQ(commands(kernel).find("sudo apt install linux-image-rt-"), 0u) << commands(kernel);
    EXPECT_EQ(commands(kernel).find("host"), std::string::npos);
    machine.put("/.dockerenv", "");
    EXPECT_NE(commands(of(real_time(machine.root(), all_rights()), "kernel")).find("host"),
              std::string::npos);
}

// Version strings in /boot/vmlinuz-* of Debian's kernel packages. The standard kernel of Debian 13
// is built without PREEMPT_RT, too, although its source contains it.
TEST(Doctor, TellsDebiansKernelsApart) {
    const GoodMachine machine;
    fs::remove(machine.root() + "/sys/kernel/realtime");
    for (const auto& [version, verdict] :
         {std::pair{"6.1.0-50-amd64 #1 SMP PREEMPT_DYNAMIC Debian 6.1.176-1 (2026-07-02)",
                    Verdict::lacks},
          {"6.1.0-50-rt-amd64 #1 SMP PREEMPT_RT Debian 6.1.176-1 (2026-07-02)", Verdict::ok},
          {"6.12.118+deb13-amd64 #1 SMP PREEMPT_DYNAMIC Debian 6.12.118-1 (2026-11-20)",
           Verdict::lacks},
          {"6.12.118+deb13-rt-amd64 #1 SMP PREEMPT_RT Debian 6.12.118-1 (2026-11-20)",
           Verdict::ok}}) {
        machine.put("/proc/version", std::string("Linux version ") + version + "\n");
        EXPECT_EQ(of(real_time(machine.root(), all_rights()), "kernel").verdict, verdict)
            << version;
    }
}

TEST(Doctor, AsksForARestartWhereAKernelForRealTimeIsInstalled) {
    const GoodMachine machine;
    fs::remove(machine.root() + "/sys/kernel/realtime");
    machine.put("/proc/sys/kernel/osrelease", "6.12.118+deb13-amd64\n");
    machine.put("/proc/version", "Linux version 6.12.118+deb13-amd64 #1 SMP PREEMPT_DYNAMIC\n");
    machine.put("/boot/vmlinuz-6.12.118+deb13-amd64", "");
    EXPECT_EQ(commands(of(real_time(machine.root(), all_rights()), "kernel")).find("sudo apt"), 0u);
#if defined(__aarch64__)
    const std::string other = "6.12.118+deb13-rt-arm64";
#else
    const std::string other = "6.12.118+deb13-rt-amd64";
#endif
    machine.put("/boot/vmlinuz-" + other, "");
    const Finding kernel = of(real_time(machine.root(), all_rights()), "kernel");
    EXPECT_EQ(kernel.verdict, Verdict::lacks);
    EXPECT_NE(kernel.found.find(other + ", which has it, is installed"), std::string::npos);
    EXPECT_EQ(commands(kernel).find("sudo reboot"), 0u) << commands(kernel);
}

TEST(Doctor, HasACommandForEachRightThatIsRefused) {
    const GoodMachine machine;
    const Findings found = real_time(machine.root(), no_rights());
    for (const char* what : {"priority", "memory", "wakefulness", "group"}) {
        EXPECT_EQ(of(found, what).verdict, Verdict::lacks) << what;
        EXPECT_FALSE(of(found, what).needed) << what;
    }
    EXPECT_EQ(commands(of(found, "priority")),
              "echo '@haptics - rtprio 81' | sudo tee -a "
              "/etc/security/limits.d/dihaptic.conf\n");
    EXPECT_NE(of(found, "priority").found.find("EPERM"), std::string::npos);
    EXPECT_EQ(commands(of(found, "memory")),
              "echo '@haptics - memlock unlimited' | sudo tee -a "
              "/etc/security/limits.d/dihaptic.conf\n");
    EXPECT_EQ(commands(of(found, "wakefulness")),
              "echo 'KERNEL==\"cpu_dma_latency\", GROUP=\"haptics\", MODE=\"0660\"' | sudo tee -a "
              "/etc/udev/rules.d/70-dihaptic.rules\n"
              "sudo udevadm control --reload && sudo udevadm trigger\n");
    EXPECT_EQ(
        commands(of(found, "group")).find("sudo groupadd -f haptics\nsudo usermod -aG haptics"),
        0u);
}

TEST(Doctor, SeesWhoHasJoinedTheGroupAndNotLoggedInSince) {
    const GoodMachine machine;
    machine.put("/etc/group", "root:x:0:\nhaptics:x:990:grace,ada\n");
    Finding group = of(real_time(machine.root(), no_rights()), "group");
    EXPECT_NE(commands(group).find("su - $USER"), std::string::npos);
    machine.put("/etc/group", "root:x:0:\nhaptics:x:990:grace,adam\nother:x:991:ada\n");
    group = of(real_time(machine.root(), no_rights()), "group");
    EXPECT_NE(commands(group).find("usermod"), std::string::npos);
    Rights member = no_rights();
    member.groups.insert("haptics");
    EXPECT_EQ(of(real_time(machine.root(), member), "group").verdict, Verdict::ok);
}

TEST(Doctor, TellsRootHowTheContainerIsStarted) {
    const GoodMachine machine;
    machine.put("/run/.containerenv", "");
    Rights rights = no_rights();
    rights.root = true;
    const Findings found = real_time(machine.root(), rights);
    EXPECT_NE(commands(of(found, "priority")).find("docker run --cap-add SYS_NICE"),
              std::string::npos);
    EXPECT_NE(commands(of(found, "memory")).find("--cap-add IPC_LOCK"), std::string::npos);
    EXPECT_NE(commands(of(found, "wakefulness")).find("--device /dev/cpu_dma_latency"),
              std::string::npos);
    for (const Finding& finding : found) EXPECT_NE(finding.what, "group");
}

TEST(Doctor, SaysWhenMemoryIsLockedInPartOnly) {
    const GoodMachine machine;
    Rights rights = all_rights();
    rights.unlimited_memory = false;
    const Finding memory = of(real_time(machine.root(), rights), "memory");
    EXPECT_EQ(memory.verdict, Verdict::note);
    EXPECT_NE(commands(memory).find("memlock unlimited"), std::string::npos);
    rights.root = true;  // root, outside any container
    EXPECT_EQ(commands(of(real_time(machine.root(), rights), "memory")).find("ulimit -l unlimited"),
              0u);
}

TEST(Doctor, SeesProcessorsThatSlowDown) {
    const GoodMachine machine;
    machine.put("/sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "powersave\n");
    const Finding slow = of(real_time(machine.root(), all_rights()), "frequency");
    EXPECT_EQ(slow.verdict, Verdict::lacks);
    EXPECT_NE(slow.found.find("1 of 2 processors"), std::string::npos) << slow.found;
    EXPECT_NE(slow.found.find("powersave"), std::string::npos);
    EXPECT_NE(commands(slow).find("echo performance | sudo tee"), std::string::npos);
    fs::remove_all(machine.root() + "/sys/devices");
    EXPECT_EQ(of(real_time(machine.root(), all_rights()), "frequency").verdict, Verdict::note);
}

TEST(Doctor, SeesVirtualMachinesContainersAndASingleProcessor) {
    const GoodMachine machine;
    machine.put("/proc/cpuinfo", "flags\t\t: fpu hypervisor vme\n");
    machine.put("/run/systemd/container", "lxc\n");
    Rights rights = all_rights();
    rights.processors = 1;
    const Findings found = real_time(machine.root(), rights);
    EXPECT_EQ(of(found, "machine").verdict, Verdict::note);
    EXPECT_NE(of(found, "machine").found.find("a virtual machine with a container (lxc)"),
              std::string::npos);
    EXPECT_EQ(of(found, "processors").verdict, Verdict::note);
}

Finding usb(const Machine& machine, const MayOpen& may_open, const std::string& maker) {
    for (const Finding& finding : ports(machine.root(), may_open)) {
        if (finding.what == "USB" && finding.found.starts_with(maker + ":")) return finding;
    }
    ADD_FAILURE() << "nothing about " << maker;
    return {};
}

TEST(Doctor, LooksWhetherUsbDevicesMayBeOpened) {
    const Machine machine;
    Finding omega = usb(machine, none_open, "Force Dimension");
    EXPECT_EQ(omega.verdict, Verdict::note);
    EXPECT_NE(omega.found.find("without a udev rule"), std::string::npos) << omega.found;

    machine.put("/etc/udev/rules.d/70-mine.rules",
                "SUBSYSTEM==\"usb\", ATTR{idVendor}==\"1451\"\n");
    omega = usb(machine, none_open, "Force Dimension");
    EXPECT_NE(omega.found.find("/etc/udev/rules.d/70-mine.rules has a rule"), std::string::npos)
        << omega.found;

    for (const auto& [file, text] : {std::pair{"idVendor", "1451\n"},
                                     {"idProduct", "0402\n"},
                                     {"busnum", "1\n"},
                                     {"devnum", "12\n"}})
        machine.put(std::string("/sys/bus/usb/devices/1-4/") + file, text);
    std::string asked;
    omega = usb(
        machine,
        [&](const std::string& file) {
            asked = file;
            return false;
        },
        "Force Dimension");
    EXPECT_EQ(asked, machine.root() + "/dev/bus/usb/001/012");
    EXPECT_EQ(omega.verdict, Verdict::lacks);
    EXPECT_EQ(commands(omega).find("echo 'SUBSYSTEM==\"usb\", ATTR{idVendor}==\"1451\", "
                                   "GROUP=\"haptics\", MODE=\"0660\"' | sudo tee -a "),
              0u)
        << commands(omega);
    EXPECT_NE(commands(omega).find("usermod -aG haptics"), std::string::npos);
    EXPECT_EQ(usb(machine, all_open, "Force Dimension").verdict, Verdict::ok);
}

TEST(Doctor, TakesNoOtherDeviceOfItsChipsMakerForAFalcon) {
    const Machine machine;
    machine.put("/sys/bus/usb/devices/1-2/idVendor", "0403\n");
    machine.put("/sys/bus/usb/devices/1-2/idProduct", "6001\n");
    EXPECT_EQ(usb(machine, none_open, "Falcon").verdict, Verdict::note);
    machine.put("/sys/bus/usb/devices/1-2/idProduct", "cb48\n");
    const Finding falcon = usb(machine, none_open, "Falcon");
    EXPECT_EQ(falcon.verdict, Verdict::lacks);
    EXPECT_NE(commands(falcon).find("ATTR{idProduct}==\"cb48\""), std::string::npos);
}

TEST(Doctor, LooksWhetherSerialLinesMayBeOpened) {
    const Machine machine;
    EXPECT_EQ(of(ports(machine.root(), none_open), "serial lines").verdict, Verdict::note);
    machine.put("/dev/ttyUSB0", "");
    machine.put("/dev/ttyACM1", "");
    machine.put("/dev/tty1", "");
    EXPECT_EQ(of(ports(machine.root(), all_open), "serial lines").verdict, Verdict::ok);
    const Finding closed =
        of(ports(machine.root(), [](const std::string& file) { return !file.ends_with("USB0"); }),
           "serial lines");
    EXPECT_EQ(closed.verdict, Verdict::lacks);
    EXPECT_EQ(closed.found.find("/dev/ttyUSB0:"), 0u) << closed.found;
    EXPECT_NE(commands(closed).find("dialout"), std::string::npos);
}

TEST(Doctor, SaysWhatADeviceOfAMakerWaitsFor) {
    const Findings found = of_maker(
        "forcedimension",
        {{{"101", "omega.6", "ready"}, {"", "device 2", "has no power: switch it on"}}, ""});
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].verdict, Verdict::ok);
    EXPECT_EQ(found[0].found, "omega.6, serial 101: ready");
    EXPECT_EQ(found[1].verdict, Verdict::note);
    EXPECT_EQ(found[1].found, "device 2: has no power: switch it on");
    EXPECT_EQ(of_maker("haply", {{}, "nothing answers. Start it."})[0].found,
              "nothing answers. Start it.");
}

TEST(Doctor, TellsACardFromSoftware) {
    const Machine machine;
    const char* const software = "llvmpipe (LLVM 15.0.6, 256 bits)";
    EXPECT_EQ(drawn_by("Mesa Intel(R) UHD", "4.6", machine.root(), none_open).verdict, Verdict::ok);
    EXPECT_EQ(drawn_by(software, "4.5", machine.root(), none_open).verdict, Verdict::note);
    machine.put("/dev/dri/card0", "");
    EXPECT_EQ(drawn_by(software, "4.5", machine.root(), none_open).verdict, Verdict::note);
    machine.put("/dev/dri/renderD128", "");
    EXPECT_EQ(drawn_by(software, "4.5", machine.root(), all_open).verdict, Verdict::note);
    const Finding closed = drawn_by(software, "4.5", machine.root(), none_open);
    EXPECT_EQ(closed.verdict, Verdict::lacks);
    EXPECT_NE(closed.found.find("/dev/dri/renderD128"), std::string::npos);
    EXPECT_NE(commands(closed).find("usermod -aG render"), std::string::npos);
}

TEST(Doctor, LooksForAScreenAndAHeadset) {
    const Machine machine;
    std::map<std::string, std::string> set{{"HOME", "/home/ada"}};
    const Variable variable = [&](const char* name) { return set[name]; };
    EXPECT_EQ(screen(variable).verdict, Verdict::note);
    set["DISPLAY"] = ":7";
    EXPECT_EQ(screen(variable).found.find("DISPLAY is :7"), 0u);

    EXPECT_EQ(headset(machine.root(), variable).verdict, Verdict::note);
    machine.put("/home/ada/.config/openxr/1/active_runtime.json", "{}");
    EXPECT_EQ(headset(machine.root(), variable).verdict, Verdict::ok);
    set["XDG_CONFIG_HOME"] = "/elsewhere";
    EXPECT_EQ(headset(machine.root(), variable).verdict, Verdict::note);
    set["XR_RUNTIME_JSON"] = "/opt/xr.json";
    machine.put("/opt/xr.json", "{}");
    EXPECT_NE(headset(machine.root(), variable).found.find("/opt/xr.json"), std::string::npos);
}

TEST(Doctor, SaysWhySoundsAreNotHeard) {
    const Machine machine;
    EXPECT_EQ(silence(machine.root(), "none", none_open).verdict, Verdict::note);
    machine.put("/dev/snd/seq", "");
    EXPECT_EQ(silence(machine.root(), "none", none_open).verdict, Verdict::note);
    machine.put("/dev/snd/pcmC0D0p", "");
    EXPECT_NE(commands(silence(machine.root(), "none", none_open)).find("usermod -aG audio"),
              std::string::npos);
    EXPECT_NE(commands(silence(machine.root(), "none", all_open)).find("speaker-test"),
              std::string::npos);
}

constexpr const char* kMounts =
    "21 1 8:2 / / rw,relatime shared:1 - ext4 /dev/sda2 rw\n"
    "30 21 0:26 / /tmp rw,nosuid - tmpfs tmpfs rw\n"
    "31 21 0:40 / /home rw - autofs systemd-1 rw\n"
    "32 31 0:41 / /home rw shared:2 master:3 - nfs4 server:/home rw\n"
    "33 21 0:42 / /mnt/my\\040disk rw - cifs //server/x rw\n";

TEST(Doctor, FindsTheFileSystemOfAFolder) {
    EXPECT_EQ(file_system(kMounts, "/srv/study"), "ext4");
    EXPECT_EQ(file_system(kMounts, "/tmp"), "tmpfs");
    EXPECT_EQ(file_system(kMounts, "/tmpfiles"), "ext4");
    EXPECT_EQ(file_system(kMounts, "/home/ada/study"), "nfs4");  // mounted on top of the autofs
    EXPECT_EQ(file_system(kMounts, "/mnt/my disk/study"), "cifs");
    EXPECT_EQ(file_system("", "/tmp"), "");
    EXPECT_EQ(file_system("damaged\n - \n", "/tmp"), "");
}

TEST(Doctor, TellsDisksThatOneShouldNotRecordTo) {
    EXPECT_EQ(kind_of_disk("ext4", System::container).verdict, Verdict::ok);
    EXPECT_EQ(kind_of_disk("overlay", System::installed).verdict, Verdict::ok);
    for (const char* type : {"nfs4", "cifs", "fuse.sshfs", "tmpfs"})
        EXPECT_EQ(kind_of_disk(type, System::installed).verdict, Verdict::note) << type;
    EXPECT_NE(kind_of_disk("overlay", System::container).found.find("lost when it is removed"),
              std::string::npos);
    EXPECT_EQ(kind_of_disk("overlay", System::live).verdict, Verdict::lacks);
    EXPECT_EQ(kind_of_disk("ext4", System::live).verdict, Verdict::ok);  // the USB stick itself
}

TEST(Doctor, ComparesTheDiskWithASession) {
    EXPECT_EQ(keeps_up(100e6, 0.45e6).verdict, Verdict::ok);
    EXPECT_EQ(keeps_up(100e6, 0.45e6).found,
              "100 MB per second; a session with two fingers writes 0.45");
    EXPECT_EQ(keeps_up(0.1e6, 0.45e6).verdict, Verdict::lacks);
    EXPECT_TRUE(keeps_up(0.1e6, 0.45e6).needed);
}

TEST(Doctor, NamesPartsThatAreMissing) {
    const auto here = [](const std::string& name) { return "/opt/" + name; };
    const auto gone = [](const std::string&) { return std::string(); };
    const Machine machine;
    Findings found = parts(gone, machine.root(), "", "");
    for (const char* needed : {"mesh", "decompose"}) {
        EXPECT_EQ(of(found, needed).verdict, Verdict::lacks);
        EXPECT_TRUE(of(found, needed).needed) << needed;
        EXPECT_EQ(commands(of(found, needed)).find("./dev build"), 0u);
    }
    EXPECT_FALSE(of(found, "host").needed);
    EXPECT_EQ(commands(of(found, "ffmpeg")), "sudo apt install ffmpeg\n");
    EXPECT_EQ(commands(of(found, "Python")).find("./dev build"), 0u);
    const Findings installed = parts(gone, machine.root(), "/usr/share/dihaptic", "");
    EXPECT_EQ(commands(of(installed, "Python")), "sudo apt install python3-dihaptic\n");
    EXPECT_EQ(of(found, "shipped files").verdict, Verdict::note);

    machine.put("/ffmpeg", "");
    fs::permissions(machine.root() + "/ffmpeg", fs::perms::owner_all);
    found = parts(here, "/nowhere:" + machine.root(), "/opt/dihaptic", "/opt/python");
    for (const char* what :
         {"mesh", "decompose", "host", "gui", "Python", "ffmpeg", "shipped files"})
        EXPECT_EQ(of(found, what).verdict, Verdict::ok) << what;
}

TEST(Doctor, SaysTheSameInAnotherProcess) {
    const Findings findings{{Verdict::lacks, "a", "b \"c\" \n", {"d", "e"}, true},
                            {Verdict::ok, "f", "caf\xe9", {}, false}};
    const std::string json = to_json(findings);
    EXPECT_EQ(json.find('\n'), std::string::npos);
    const Findings read = from_json(json);
    ASSERT_EQ(read.size(), 2u);
    EXPECT_EQ(read[0].verdict, Verdict::lacks);
    EXPECT_EQ(read[0].found, findings[0].found);
    EXPECT_EQ(read[0].commands, findings[0].commands);
    EXPECT_TRUE(read[0].needed);
    EXPECT_FALSE(read[1].needed);
    EXPECT_THROW(from_json(""), std::exception);
    EXPECT_THROW(from_json("[[7]]"), std::exception);
}

TEST(Doctor, PrintsCommandsAsOneTypesThem) {
    const std::string text = to_text({Verdict::lacks,
                                      "kernel",
                                      std::string(80, 'x') + " " + std::string(80, 'y'),
                                      {"sudo " + std::string(150, 'z')}});
    const std::string indent(24, ' ');
    EXPECT_EQ(text, "  lacks  kernel         " + std::string(80, 'x') + "\n" + indent +
                        std::string(80, 'y') + "\n" + indent + "    sudo " + std::string(150, 'z') +
                        "\n");
}

}  // namespace
}  // namespace dihaptic::doctor::doctor_test
