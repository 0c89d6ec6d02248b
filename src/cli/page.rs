//! Pages that commands write.

use std::io::Write;
use std::path::Path;

use super::outcome::Failure;
use crate::study::quoted;

/// The command line of this process, as a shell takes it.
pub fn command_line() -> String {
    let arguments: Vec<String> = std::env::args().skip(1).map(|a| quoted(&a)).collect();
    format!("dalembert {}", arguments.join(" "))
}

/// Writes a page, whole or not at all.
pub fn write_page(path: &Path, page: &str) -> Result<(), Failure> {
    let failed = |error: &dyn std::fmt::Display| {
        Failure::system(format!("cannot write the page {}: {error}", path.display()))
    };
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty());
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    {
        use std::fs::Permissions;
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(Permissions::from_mode(0o666)); // less the umask
    }
    let mut file = builder
        .tempfile_in(folder.unwrap_or(Path::new(".")))
        .map_err(|e| failed(&e))?;
    file.write_all(page.as_bytes())
        .and_then(|()| file.as_file().sync_all())
        .map_err(|e| failed(&e))?;
    file.persist(path).map_err(|e| failed(&e.error))?;
    Ok(())
}
