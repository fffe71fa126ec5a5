"""KV10x to KV14x: the file and the tree, before any mesh is opened."""

from __future__ import annotations

from kinematify.validation.catalogue.check import Check
from kinematify.validation.finding import Blame, Severity

CHECKS: tuple[Check, ...] = (
    Check(
        id="KV101",
        title="The file is well-formed XML",
        severity=Severity.ERROR,
        blame=Blame.ASSET,
        verifies="The XML parser reads the whole file.",
        matters="No reader loads a file that breaks off or holds a stray sign; some crash instead of saying where.",
        remedy="Correct the line that is named; if the file ends too early, export or copy it again.",
    ),
    Check(
        id="KV102",
        title="No DOCTYPE and no entities",
        severity=Severity.ERROR,
        blame=Blame.ASSET,
        verifies="The file declares neither a DOCTYPE nor entities.",
        matters=(
            "A few lines of entities can unfold to gigabytes, and external ones read files of the machine. No "
            "URDF needs them."
        ),
        remedy="Delete the declaration and write the values where they are used.",
    ),
    Check(
        id="KV103",
        title="Size within the caps",
        severity=Severity.ERROR,
        blame=Blame.ASSET,
        verifies=(
            "Elements, links and joints, and how deep links hang one below the other, stay below `max_elements`, "
            "`max_links` and `max_depth`."
        ),
        matters="A chain of 20,000 links hangs MuJoCo and crashes Pinocchio; no known robot has more than about 150.",
        remedy="Split the model, or merge links that fixed joints hold together.",
    ),
    Check(
        id="KV104",
        title="Lines and names short enough",
        severity=Severity.WARNING,
        blame=Blame.ASSET,
        verifies="No line is longer than `max_line_bytes`, no name longer than `max_name`.",
        matters="PyBullet fails on lines of 8 KB and crashes on a robot name of 1,100 characters.",
        remedy="Format the file with one tag per line; shorten the names.",
    ),
    Check(
        id="KV105",
        title="Elements once and in their place",
        severity=Severity.WARNING,
        blame=Blame.ASSET,
        verifies="What may stand once in its parent stands once, and what URDF knows stands where URDF wants it.",
        matters=(
            "With two <origin> elements one reader takes the first, another the last; a <link> inside a <link> is "
            "not there for any."
        ),
        remedy="Keep one element, in the place that the finding names.",
    ),
    Check(
        id="KV106",
        title="Elements are known",
        severity=Severity.NOTE,
        blame=Blame.ASSET,
        verifies="Elements that neither URDF nor the usual extensions define are counted by kind.",
        matters="A tag with a typing mistake is ignored in silence, with all that it says.",
        remedy="Correct the tag, or delete it if nothing reads it.",
    ),
    Check(
        id="KV110",
        title="Names present",
        severity=Severity.ERROR,
        blame=Blame.ASSET,
        verifies="Every link and joint has a name; the robot should have one.",
        matters="Without a name nothing can refer to it; most readers stop.",
        remedy="Name it.",
    ),
    Check(
        id="KV111",
        title="Names unique",
        severity=Severity.ERROR,
        blame=Blame.ASSET,
        verifies="No two links, and no two joints, have the same name.",
        matters="Readers keep one of the two, and not the same one.",
        remedy="Rename one of them, and correct what refers to it.",
    ),
    Check(
        id="KV112",
        title="Names usable elsewhere",
        severity=Severity.WARNING,
        blame=Blame.ASSET,
        verifies=(
            "Names hold no spaces, slashes, quotes and the like; a link below a joint is not called world. Other "
            "signs that are no part of identifiers are a note."
        ),
        matters="USD, ROS and MuJoCo change or refuse such names, so that results cannot be matched.",
        remedy="Use letters, digits and underscores.",
    ),
    Check(
        id="KV120",
        title="There are links",
        severity=Severity.ERROR,
        blame=Blame.ASSET,
        verifies="At least one <link> stands in the <robot>.",
        matters="An empty model proves nothing.",
        remedy="Give a URDF with at least one link.",
    ),
    Check(
        id="KV121",
        title="Parents and children exist",
        severity=Severity.ERROR,
        blame=Blame.KINEMATICS,
        verifies="Every joint names a parent and a child, and both are links of the file.",
        matters="Readers stop, or drop the joint with all that hangs on it.",
        remedy="Correct the name of the link.",
    ),
    Check(
        id="KV122",
        title="Parent and child differ",
        severity=Severity.ERROR,
        blame=Blame.KINEMATICS,
        verifies="No joint joins a link to itself.",
        matters="PyBullet crashes with such a joint.",
        remedy="Name two different links.",
    ),
    Check(
        id="KV123",
        title="One parent per link",
        severity=Severity.ERROR,
        blame=Blame.KINEMATICS,
        verifies="No link is the child of two joints.",
        matters="A URDF is a tree; readers keep one of the joints, not always the same.",
        remedy="Cut one of the joints.",
    ),
    Check(
        id="KV124",
        title="No circle of links",
        severity=Severity.ERROR,
        blame=Blame.KINEMATICS,
        verifies="Following joints downward never leads back to a link above.",
        matters="Readers without a guard never end; the others refuse the file.",
        remedy="Cut the joint that closes the circle, or correct its parent.",
    ),
    Check(
        id="KV125",
        title="One root",
        severity=Severity.ERROR,
        blame=Blame.KINEMATICS,
        verifies="One link carries all others.",
        matters="PyBullet crashes with two roots; MuJoCo welds the second to the world without a word.",
        remedy="Join the second root to the rest by a fixed joint, or split the file.",
    ),
    Check(
        id="KV126",
        title="No isolated link",
        severity=Severity.ERROR,
        blame=Blame.KINEMATICS,
        verifies="Every link hangs on a joint or carries one, unless it is the only link.",
        matters="It is a second root: it stays behind when the model moves, or crashes the engine.",
        remedy="Join it by a joint, or delete it.",
    ),
    Check(
        id="KV127",
        title="Leaders of mimic joints exist",
        severity=Severity.ERROR,
        blame=Blame.KINEMATICS,
        verifies="Every <mimic> names a joint of the file.",
        matters="All loaders accept a missing leader in silence, and the joint then moves freely or not at all.",
        remedy="Correct the name of the leader.",
    ),
    Check(
        id="KV128",
        title="Mimic joints follow a leader",
        severity=Severity.ERROR,
        blame=Blame.KINEMATICS,
        verifies=(
            "Followers do not follow each other in a circle, nor in chains of more than `max_mimic_chain`; a "
            "follower of a follower is a warning."
        ),
        matters="A circle has no value that is right; readers without a guard never end.",
        remedy="Let one of them lead, and let the others name it.",
    ),
    Check(
        id="KV130",
        title="Joint types are known",
        severity=Severity.ERROR,
        blame=Blame.KINEMATICS,
        verifies="Every type is revolute, continuous, prismatic, fixed, floating or planar.",
        matters="Readers stop, or take the joint for fixed.",
        remedy="Write one of the types of URDF.",
    ),
    Check(
        id="KV131",
        title="Joint types are supported",
        severity=Severity.ERROR,
        blame=Blame.KINEMATICS,
        verifies=(
            "No floating or planar joint stands below a link with geometry. Above the root body it is a note: it "
            "says that the model stands freely."
        ),
        matters=(
            "Engines differ in how they read such joints, most as fixed, so that nothing about the model could be "
            "compared."
        ),
        remedy="Describe it as several joints with one axis each.",
    ),
    Check(
        id="KV132",
        title="Numbers are finite and complete",
        severity=Severity.ERROR,
        blame=Blame.ASSET,
        verifies="Every attribute that holds numbers holds the right count of plain, finite ones.",
        matters="A NaN in an axis passes MuJoCo and PyBullet and turns every later state into NaN.",
        remedy="Write plain numbers separated by spaces; find out why the exporter failed there.",
    ),
    Check(
        id="KV133",
        title="Numbers are of a plausible size",
        severity=Severity.ERROR,
        blame=Blame.ASSET,
        verifies=(
            "No number is larger than `max_number` (a warning for effort, velocity, damping and friction), and no "
            "roll, pitch or yaw is more than one turn (a warning)."
        ),
        matters=(
            "With 1e16 metres or radians all digits are lost and simulations end in NaN; angles above a turn are "
            "degrees most of the time."
        ),
        remedy="Write the true value in metres, radians and kilograms; use a continuous joint where there is no limit.",
    ),
    Check(
        id="KV134",
        title="Axes have a direction",
        severity=Severity.ERROR,
        blame=Blame.KINEMATICS,
        verifies="No axis of a joint that moves has a length of `zero_axis` or less.",
        matters="PyBullet moves such a joint in some direction; MuJoCo stops.",
        remedy="Write a unit vector along the hinge line or the direction of sliding.",
    ),
    Check(
        id="KV135",
        title="Axes have unit length",
        severity=Severity.WARNING,
        blame=Blame.KINEMATICS,
        verifies=(
            "The length of an axis is one within `unit_axis_tolerance`; it is only a note within "
            "`rounded_axis_tolerance`."
        ),
        matters="Readers that do not normalise it turn the joint too far or not far enough.",
        remedy="Divide the axis by its length.",
    ),
    Check(
        id="KV136",
        title="Joints with limits state them",
        severity=Severity.ERROR,
        blame=Blame.KINEMATICS,
        verifies=(
            "Every revolute and prismatic joint has a <limit>; one that states neither lower nor upper is a warning."
        ),
        matters="MuJoCo takes the joint for unlimited, PyBullet and Pinocchio refuse the file.",
        remedy="Add the <limit>, or make the joint continuous.",
    ),
    Check(
        id="KV137",
        title="Limits stand in order",
        severity=Severity.ERROR,
        blame=Blame.KINEMATICS,
        verifies="lower is not above upper.",
        matters="MuJoCo takes the joint for unlimited, others lock it.",
        remedy="Swap the two values.",
    ),
    Check(
        id="KV138",
        title="Sizes of primitives",
        severity=Severity.ERROR,
        blame=Blame.ASSET,
        verifies="Every length of a box, sphere, cylinder or capsule is above zero.",
        matters="PyBullet accepts a negative size and collides with something else than the picture shows.",
        remedy="Write the true size in metres.",
    ),
    Check(
        id="KV139",
        title="Scales of meshes",
        severity=Severity.ERROR,
        blame=Blame.ASSET,
        verifies="No factor of a mesh scale is zero (`zero_scale`); a negative one is a note.",
        matters="A mesh scaled by zero vanishes; a mirrored one is inside out for some readers.",
        remedy="Write the factor from the unit of the mesh to metres.",
    ),
    Check(
        id="KV140",
        title="Geometry elements are complete",
        severity=Severity.ERROR,
        blame=Blame.ASSET,
        verifies="Every visual and collision holds one known shape with the attributes that it needs.",
        matters="Readers stop, or drop the shape in silence.",
        remedy="Give every visual and collision one complete shape.",
    ),
    Check(
        id="KV141",
        title="Mesh files exist",
        severity=Severity.ERROR,
        blame=Blame.ASSET,
        verifies="Every file name leads to a file, through packages where it says so.",
        matters="The link is invisible and collides with nothing, or the model does not load.",
        remedy="Put the file there, correct the path, or name the package's folder with --package-dir.",
    ),
    Check(
        id="KV142",
        title="Mesh formats can be read",
        severity=Severity.ERROR,
        blame=Blame.ASSET,
        verifies="Every mesh is of a format that is read here; formats that MuJoCo does not read are a note.",
        matters="Each reader knows other formats; what it does not know it drops or refuses.",
        remedy="Convert the mesh to OBJ or binary STL.",
    ),
    Check(
        id="KV143",
        title="Mesh files have names of their own",
        severity=Severity.NOTE,
        blame=Blame.ASSET,
        verifies="No two different mesh files have the same name without folder and suffix.",
        matters="MuJoCo names meshes after their files: of two called alike, one is shown for both.",
        remedy="Rename one of the files.",
    ),
    Check(
        id="KV144",
        title="Mesh paths hold elsewhere",
        severity=Severity.NOTE,
        blame=Blame.ASSET,
        verifies="No mesh path is absolute or written with backslashes.",
        matters="The model works on the author's machine only.",
        remedy="Write paths relative to the URDF, or package://NAME/PATH.",
    ),
)
