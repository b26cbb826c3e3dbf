//! Bindings to the PETSc and the MPI that are installed, from their own headers, of nothing but what is called.

use std::path::PathBuf;
use std::process::Command;

const FUNCTIONS: [&str; 8] = [
    "signal|_exit|dmumps_c",
    "MPI_(Init_thread|Finalize|Abort|Comm_(dup|rank|size)|Allgatherv|Gatherv|Ibarrier|Test|Get_library_version)",
    "Petsc(InitializeNoArguments|Finalize|GetVersionNumber|ErrorMessage|PushErrorHandler|ReturnErrorHandler|GlobalMinMaxInt)",
    "PetscDataType(GetSize|ToMPIDataType)|PetscOptions(SetValue|InsertString|LeftGet|LeftRestore)|PetscObjectTypeCompare",
    "Vec(CreateMPIWithArray|SetBlockSize|Destroy|GetArray|RestoreArray)",
    "Mat(CreateMPIAIJWithArrays|UpdateMPIAIJWithArray|SetBlockSize|SetNearNullSpace|NullSpace(CreateRigidBody|Destroy)|Destroy)",
    "Mat(CreateVecs|CreateDense|LUFactor|Shift|Dense(GetLocalMatrix|GetArray|RestoreArray)|Assembly(Begin|End))",
    "KSP(Create|Reset|SetOperators|SetTolerances|SetFromOptions|SetUp|Reset|Solve|MatSolve|Get(PC|IterationNumber|ConvergedReason)|Destroy)|PC(GetFailedReason|FactorGetMatrix)|MatGetInfo",
];
const VARIABLES: &str =
    "SIG(SEGV|ABRT)|PETSC_COMM_WORLD|PETSC_VERSION_(MAJOR|MINOR)|MPI_THREAD_SERIALIZED|MPI_MAX_LIBRARY_VERSION_STRING";

fn main() {
    println!("cargo:rerun-if-changed=headers.h");
    println!("cargo:rerun-if-env-changed=MPICC");
    let petsc = pkg_config::Config::new().atleast_version("3.18").probe("PETSc");
    let petsc =
        petsc.unwrap_or_else(|error| panic!("PETSc 3.18 or newer is needed (Debian: libpetsc-real-dev): {error}"));
    let mut arguments: Vec<String> = petsc.include_paths.iter().map(|path| format!("-I{}", path.display())).collect();
    for word in mpi() {
        match word.split_at(word.len().min(2)) {
            ("-I", _) => arguments.push(word),
            ("-L", path) => println!("cargo:rustc-link-search=native={path}"),
            ("-l", library) => println!("cargo:rustc-link-lib={library}"),
            _ => {}
        }
    }
    println!("cargo:rustc-link-lib=dmumps");
    let bindings = FUNCTIONS.iter().fold(bindgen::builder(), |builder, names| builder.allowlist_function(names));
    let bindings = bindings.header("headers.h").clang_args(arguments).allowlist_var(VARIABLES).layout_tests(false);
    let to = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo says it")).join("bindings.rs");
    let written = bindings.generate().expect("headers that clang reads").write_to_file(to);
    written.expect("a folder to write to");
}

/// What the wrapper compiler of MPI adds.
fn mpi() -> Vec<String> {
    let wrapper = std::env::var("MPICC").unwrap_or_else(|_| "mpicc".into());
    let shown = Command::new(&wrapper).arg("-show").output();
    let shown = shown.unwrap_or_else(|error| panic!("{wrapper}, the compiler of an MPI, is needed: {error}"));
    String::from_utf8_lossy(&shown.stdout).split_whitespace().map(str::to_owned).collect()
}
