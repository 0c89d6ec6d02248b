//! Links the problems, which run.py has compiled into the folder PEERS_LIBRARIES.

fn main() {
    let folder = std::env::var("PEERS_LIBRARIES").expect("run.py sets PEERS_LIBRARIES");
    println!("cargo:rerun-if-env-changed=PEERS_LIBRARIES");
    println!("cargo:rustc-link-search=native={folder}");
    for library in ["problems", "tank"] {
        println!("cargo:rerun-if-changed={folder}/lib{library}.a");
        println!("cargo:rustc-link-lib=static={library}");
    }
    println!("cargo:rustc-link-lib=dylib=stdc++");
}
